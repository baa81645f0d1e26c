// Not part of the suites: a race that the thread sanitiser must report. A suppression or an order
// told by mistake that hides it would hide every race of the library's loops.

#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "skyhalo/base/for_each_index.hpp"

int main() {
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  long sum = 0;
  for (int round = 0; round < 20; ++round) {
    skyhalo::for_each_index(4, [&](std::size_t i) {
      sum += static_cast<long>(i);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  }
  std::printf("%ld\n", sum);
  return 0;
}

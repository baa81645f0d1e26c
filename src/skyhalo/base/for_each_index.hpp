#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define SKYHALO_THREAD_SANITISER 1
extern "C" void __tsan_acquire(void* address);  // NOLINT(*-reserved-identifier,cert-dcl*)
extern "C" void __tsan_release(void* address);  // NOLINT(*-reserved-identifier,cert-dcl*)
#endif
#endif

namespace skyhalo {

/// Tells the thread sanitiser of an order that libtbb keeps, which is not built with it: what
/// happened before `reach` is seen after `pass`. Does nothing elsewhere.
class Milestone {
 public:
#ifdef SKYHALO_THREAD_SANITISER
  void reach() noexcept {
    __tsan_release(&address_);
  }

  void pass() noexcept {
    __tsan_acquire(&address_);
  }

 private:
  char address_ = 0;
#else
  void reach() noexcept {}

  void pass() noexcept {}
#endif
};

/// Calls `act` when it goes out of scope, whether by return or by exception.
template <class Act>
class AtExit {
 public:
  explicit AtExit(const Act& act) noexcept : act_(act) {}

  AtExit(const AtExit&) = delete;
  AtExit(AtExit&&) = delete;
  AtExit& operator=(const AtExit&) = delete;
  AtExit& operator=(AtExit&&) = delete;

  ~AtExit() { act_(); }

 private:
  Act act_;
};

/// Calls `work(i)` for i = 0 ... count - 1 on TBB's threads. Returns when all are done; throws what
/// one of them threw.
template <class Work>
void for_each_index(std::size_t count, const Work& work) {
  Milestone begun;
  Milestone ended;
  begun.reach();
  const AtExit all_ended([&ended]() noexcept { ended.pass(); });
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    begun.pass();
    const AtExit one_ended([&ended]() noexcept { ended.reach(); });
    work(i);
  });
}

}  // namespace skyhalo

#pragma once

#include <memory>

namespace skyhalo::sgm {

/// Something to do for each of a number of indices. Refers to what it was made of.
class Task {
 public:
  template <class Work>
  explicit Task(const Work& work) noexcept
      : work_(std::addressof(work)),
        call_([](const void* of, int i) { (*static_cast<const Work*>(of))(i); }) {}

  void operator()(int i) const { call_(work_, i); }

 private:
  const void* work_;
  void (*call_)(const void*, int);
};

/// Where the parts of an image are worked on: on one thread or on many.
class Executor {
 public:
  Executor() = default;
  Executor(const Executor&) = default;
  Executor(Executor&&) = default;
  Executor& operator=(const Executor&) = default;
  Executor& operator=(Executor&&) = default;
  virtual ~Executor() = default;

  /// Calls `task(i)` for i = 0 ... count - 1, in any order. Returns when all are done.
  virtual void for_each(int count, const Task& task) = 0;
};

/// One after the other, on the caller's thread.
class SerialExecutor final : public Executor {
 public:
  void for_each(int count, const Task& task) override {
    for (int i = 0; i < count; ++i) {
      task(i);
    }
  }
};

}  // namespace skyhalo::sgm

#pragma once

#include <gtest/gtest.h>

#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo::testing {

/// The message of the `Error` that `action` throws; fails the test when there is none or it is of
/// another kind.
template <class Action>
std::string message_of(Action&& action, ErrorKind kind = ErrorKind::kInput) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return "";
}

}  // namespace skyhalo::testing

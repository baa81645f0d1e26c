#include "skyhalo/calibration/json_value.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using ::testing::Not;
using testing::TempFolder;

JsonValue root_of(const TempFolder& folder, const std::string& text) {
  return JsonValue::load(folder.write("a.json", text));
}

TEST(JsonValueTest, ValuesAreFoundByKeyAndPlace) {
  const TempFolder folder;
  const JsonValue root = root_of(folder, R"({"a": {"b.c": [1, 2.5, "x"]}})");
  EXPECT_TRUE(root.has("a"));
  EXPECT_FALSE(root.has("b.c"));
  const std::vector<JsonValue> items = root.at("a").at("b.c").items();
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(items[0].whole_number(), 1);
  EXPECT_EQ(items[1].number(), 2.5);
  EXPECT_EQ(items[2].text(), "x");
}

TEST(JsonValueTest, ComplaintsNameThePath) {
  const TempFolder folder;
  const JsonValue root = root_of(folder, R"({"a": [{"b": null, "c": 2.5, "d": []}]})");
  const JsonValue item = root.at("a").items()[0];
  const std::string file = (folder.path() / "a.json").string();
  EXPECT_EQ(message_of([&] { (void)item.at("b").number(); }),
            file + ": a[0].b: expected a finite number, found null");
  EXPECT_EQ(message_of([&] { (void)item.at("c").whole_number(); }),
            file + ": a[0].c: expected a whole number, found 2.5");
  EXPECT_EQ(message_of([&] { (void)item.at("c").text(); }),
            file + ": a[0].c: expected a text, found 2.5");
  EXPECT_EQ(message_of([&] { (void)item.at("d").at("e"); }),
            file + ": a[0].d: expected an object, found a list");
  EXPECT_EQ(message_of([&] { (void)item.items(); }),
            file + ": a[0]: expected a list, found an object");
  EXPECT_EQ(message_of([&] { (void)item.at("e"); }), file + ": a[0].e: this key is missing");
}

TEST(JsonValueTest, NumbersAreFiniteAndFit) {
  const TempFolder folder;
  const JsonValue root = root_of(folder, R"({"n": 3000000000, "s": "1"})");
  EXPECT_EQ(root.at("n").number(), 3e9);
  EXPECT_THAT(message_of([&] { (void)root.at("n").whole_number(); }), HasSubstr("n: expected"));
  EXPECT_THAT(message_of([&] { (void)root.at("s").number(); }), HasSubstr("s: expected"));
}

TEST(JsonValueTest, WordsThatJsonHasNotAreRefusedWhereANumberIsAskedFor) {
  const TempFolder folder;
  const JsonValue root =
      root_of(folder, R"({"NaN": [NaN, -Infinity, "a \"nan\" in a text"], "b": 1})");
  EXPECT_EQ(root.at("b").number(), 1.0);
  const std::vector<JsonValue> items = root.at("NaN").items();
  EXPECT_THAT(message_of([&] { (void)items[0].number(); }),
              HasSubstr("NaN[0]: expected a finite number, found \"NaN\""));
  EXPECT_THAT(message_of([&] { (void)items[1].number(); }), HasSubstr("NaN[1]"));
  EXPECT_EQ(items[2].text(), "a \"nan\" in a text");
}

TEST(JsonValueTest, WhatIsNoJsonObjectIsRefused) {
  testing::expect_no_content_refused(
      "a.json", [](const std::filesystem::path& file) { (void)JsonValue::load(file); });
  const TempFolder folder;
  for (const std::string bad : {"[1, 2]", "{\"a\": 1", "3", " \n", "{\"a\": 1e999}"}) {
    SCOPED_TRACE(bad);
    EXPECT_THAT(message_of([&] { (void)root_of(folder, bad); }),
                HasSubstr((folder.path() / "a.json").string()));
  }
}

TEST(JsonValueTest, AMistakeInTheSyntaxIsNamedByItsLine) {
  const TempFolder folder;
  const std::string file = (folder.path() / "a.json").string();
  const auto refusal = [&](const std::string& text) {
    return message_of([&] { (void)root_of(folder, text); });
  };
  for (const std::string bad : {"{\n  \"a\": 1,\n  \"b\": 35x\n}\n",
                                "{\n  \"a\": NaN,\n  \"b\": -Infinity x}\n",
                                "{\n\n\"a\": [1, 2"}) {
    SCOPED_TRACE(bad);
    EXPECT_THAT(refusal(bad),
                AllOf(HasSubstr(file + ":3: not valid JSON: "),
                      Not(HasSubstr("exception")),
                      Not(HasSubstr("parse error"))));
  }
  EXPECT_EQ(refusal("{\"a\": 1e999}"), file + ": not valid JSON: number overflow parsing '1e999'");
}

TEST(JsonValueTest, DeepNestingIsRefusedBeforeItIsCopied) {
  const TempFolder folder;
  const std::string text = "{\"a\": " + std::string(200000, '[') + std::string(200000, ']') + "}";
  EXPECT_THAT(message_of([&] { (void)root_of(folder, text).at("a"); }),
              AllOf(HasSubstr((folder.path() / "a.json").string()), HasSubstr("nested too deep")));
}

}  // namespace
}  // namespace skyhalo

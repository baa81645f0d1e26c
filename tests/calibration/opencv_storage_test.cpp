#include "skyhalo/calibration/opencv_storage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr std::array<std::string_view, 2> kNames = {"M1", "K1"};

OpencvStorage storage_of(const TempFolder& folder,
                         const std::string& text,
                         const std::string& name = "a.yml") {
  const std::vector<std::filesystem::path> files = {folder.write(name, text)};
  return OpencvStorage(files);
}

TEST(OpencvStorageTest, MatricesAreReadFromYamlXmlAndJson) {
  const TempFolder folder;
  const std::string yml =
      "%YAML:1.0\n---\nK1: !!opencv-matrix\n   rows: 2\n   cols: 2\n   dt: d\n"
      "   data: [ 1., 2.5, -3., 4.0e-01 ]\n";
  const std::string xml =
      "<?xml version=\"1.0\"?>\n<opencv_storage>\n<K1 type_id=\"opencv-matrix\">\n"
      "  <rows>2</rows>\n  <cols>2</cols>\n  <dt>d</dt>\n  <data>\n    1. 2.5 -3. 4.0e-01</data>"
      "</K1>\n</opencv_storage>\n";
  const std::string json =
      "{\n    \"K1\": {\n        \"type_id\": \"opencv-matrix\",\n        \"rows\": 2,\n"
      "        \"cols\": 2,\n        \"dt\": \"d\",\n"
      "        \"data\": [ 1.0, 2.5, -3.0, 4.0e-01 ]\n    }\n}\n";
  for (const std::string& text : {yml, xml, json}) {
    const OpencvStorage storage = storage_of(folder, text);
    const OpencvEntry entry = storage.at(kNames);
    EXPECT_EQ(entry.key, "K1");
    EXPECT_THAT(entry.numbers(), ElementsAre(1.0, 2.5, -3.0, 0.4));
    EXPECT_THAT(message_of([&] { (void)entry.numbers(9); }),
                AllOf(HasSubstr("a.yml: K1: expected 9 numbers, found 4")));
  }
}

TEST(OpencvStorageTest, PlainListsAndMissingDirectivesAreRead) {
  const TempFolder folder;
  const OpencvStorage storage = storage_of(folder, "M1: [ [1, 2], [3, 4] ]\nname: fisheye\nn: 3\n");
  EXPECT_THAT(storage.at(kNames).numbers(), ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(storage.find("name")->text(), "fisheye");
  EXPECT_EQ(storage.find("n")->text(), "3");
  EXPECT_THAT(storage.find("n")->numbers(), ElementsAre(3));
}

TEST(OpencvStorageTest, SeveralFilesAreTakenTogether) {
  const TempFolder folder;
  const std::vector<std::filesystem::path> files = {
      folder.write("intrinsics.yml", "%YAML:1.0\n---\nM1: [ 1 ]\n"),
      folder.write("extrinsics.yml", "%YAML:1.0\n---\nR: [ x ]\n")};
  const OpencvStorage storage(files);
  EXPECT_EQ(storage.find("M1")->file, files[0]);
  EXPECT_THAT(message_of([&] { (void)storage.find("R")->numbers(); }),
              HasSubstr(files[1].string() + ": R: expected finite numbers, found 'x'"));
  EXPECT_FALSE(storage.find("T"));
  constexpr std::array<std::string_view, 2> kOther = {"M2", "K2"};
  EXPECT_THAT(message_of([&] { (void)storage.at(kOther); }),
              AllOf(HasSubstr(files[0].string()),
                    HasSubstr(files[1].string()),
                    HasSubstr("M2 (nor K2): this key is missing")));
}

TEST(OpencvStorageTest, NumbersMustBeFiniteAndFitTheSize) {
  const TempFolder folder;
  const OpencvStorage storage =
      storage_of(folder,
                 "%YAML:1.0\n---\nM1: [ 1., .Nan ]\nK1: !!opencv-matrix\n   rows: 2\n   cols: 2\n"
                 "   dt: d\n   data: [ 1., 2. ]\n");
  EXPECT_THAT(message_of([&] { (void)storage.find("M1")->numbers(); }), HasSubstr("M1: expected"));
  EXPECT_THAT(message_of([&] { (void)storage.find("K1")->numbers(); }),
              HasSubstr("K1: expected rows x cols numbers, found 2"));
}

TEST(OpencvStorageTest, WhatOpencvCannotReadIsAnErrorThatNamesTheFile) {
  testing::expect_no_content_refused("a.yml", [](const std::filesystem::path& file) {
    const std::vector<std::filesystem::path> files = {file};
    const OpencvStorage storage(files);
  });
  const TempFolder folder;
  for (const std::string bad : {"%YAML:1.0\n---\nM1: [ 1, 2\n",
                                "<?xml version=\"1.0\"?>\n<opencv_storage>\n<M1>",
                                "{\"M1\": [1, 2",
                                "hello",
                                "\x89PNG\r\n\x1a\n"}) {
    SCOPED_TRACE(bad);
    EXPECT_THAT(message_of([&] { (void)storage_of(folder, bad); }),
                HasSubstr((folder.path() / "a.yml").string()));
  }
}

TEST(OpencvStorageTest, NestingThatOpencvCannotParseIsRefused) {
  const TempFolder folder;
  const std::string deep(200000, '[');
  std::string tags = "<?xml version=\"1.0\"?>\n<opencv_storage>\n";
  for (int i = 0; i < 200000; ++i) {
    tags += "<a>";
  }
  for (const std::string& text : {"M1: " + deep, "{\"M1\": " + deep, tags}) {
    SCOPED_TRACE(text.substr(0, 30));
    EXPECT_THAT(message_of([&] { (void)storage_of(folder, text); }),
                AllOf(HasSubstr((folder.path() / "a.yml").string()), HasSubstr("nested too deep")));
  }
}

}  // namespace
}  // namespace skyhalo

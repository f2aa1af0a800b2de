// Damages a JSON file and expects the error of its reader.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include "../../../tests/temporary_folder.h"
#include "fovea/city/json_values.h"
#include "fovea/errors.h"

namespace fovea {

class JsonFileTest : public testing::Test {
 protected:
  using Path = std::filesystem::path;

  /// @param noun, command  that an error must name: the kind of file, and the command that makes it
  /// @param write_good     writes an undamaged file
  JsonFileTest(const char* name, const char* noun, const char* command,
               const std::function<void(const Path&)>& write_good,
               std::function<void(const Path&)> read)
      : path_(folder_ / name), noun_(noun), command_(command), read_(std::move(read)) {
    write_good(path_);
    json_ = Json::parse(std::ifstream(path_));
  }

  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(path_).rdbuf();
    return text.str();
  }

  void expect_damaged(const std::string& text) const {
    write(text);
    try {
      read_(path_);
      ADD_FAILURE() << "no error for:\n" << text.substr(0, 2000);
    } catch (const InputError& error) {
      EXPECT_EQ(error.where(), path_.string());
      EXPECT_THAT(error.problem(), testing::HasSubstr(noun_));
      EXPECT_THAT(error.remedy(), testing::HasSubstr(command_));
    }
  }
  /// Expects an error with another value at a place such as "/maps/0/matches".
  void expect_damaged_with(const std::string& place, const Json& value) const {
    SCOPED_TRACE(place + " = " + value.dump());
    Json json = json_;
    json[Json::json_pointer(place)] = value;
    expect_damaged(json.dump());
  }

  TemporaryFolder folder_;
  Path path_;
  Json json_;  // of the undamaged file

 private:
  std::string noun_, command_;
  std::function<void(const Path&)> read_;
};

}  // namespace fovea

// What a command may write: no input, no other output, no file of another kind.
#include "fovea/drive/command_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace fovea::command_files_test {

using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kAccepted = "accepted";
constexpr const char* kPly = "ply\nformat ascii 1.0\n";
constexpr const char* kPose = "1 0 0 0 0 1 0 0 0 0 1 0\n";

class CommandFilesTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string file(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return path(name);
  }
  std::string map(const std::string& name) const {
    MapWriter::create(folder_ / name, true)->finish();
    return path(name);
  }
  static std::string answer(const CommandFiles& files) {
    try {
      check_files(files);
    } catch (const OutputError& error) {
      return error.what();
    }
    return kAccepted;
  }
  const TemporaryFolder folder_;
};

TEST_F(CommandFilesTest, ContentTellsTheKindOfAFile) {
  using namespace std::string_literals;
  const std::pair<std::string, ContentKind> cases[] = {
      {"", ContentKind::kEmpty},
      {"SQLite format 3\0"s + std::string(52, 'x') + "FVEA", ContentKind::kMap},
      {"SQLite format 3\0"s + std::string(84, '\0'), ContentKind::kSqlite},
      {"SQLite format 3\0"s, ContentKind::kSqlite},
      {"ply\r\nformat", ContentKind::kPly},
      {"ply \nformat", ContentKind::kPly},
      {"plywood\n", ContentKind::kOther},
      {"# .PCD v0.7 - Point Cloud Data\n", ContentKind::kPcd},
      {"LASF\0"s, ContentKind::kLas},
      {"glTF\2"s, ContentKind::kGlb},
      {"\x89PNG\r\n\x1a\n", ContentKind::kPng},
      {"0.05\n0\n0\n-0.05\n458319.275\n5428740.425\n", ContentKind::kWorldFile},
      {"0.05\n0\n0\n-0.05\n458319.275\n", ContentKind::kOther},
      {"0.05\n0\n0\n-0.05\nwest\nnorth\n", ContentKind::kOther},
      {"<PAMDataset>\n", ContentKind::kRasterAuxiliary},
      {"\n<!DOCTYPE HTML>", ContentKind::kHtml},
      {"{\n  \"map\": {}}", ContentKind::kReport},
      {"{\"protocol\": \"truth\"}", ContentKind::kReport},
      {"{\"name\": \"a package\"}", ContentKind::kJson},
      {"{not json", ContentKind::kOther},
      {"[registration]\nmethod = 1\n", ContentKind::kOther},
      {kPose, ContentKind::kPoses},
      {"nan nan nan nan nan nan nan nan nan nan nan nan\n", ContentKind::kPoses},
      {"1 2 3 4 5 6 7 8 9 10 11\n", ContentKind::kOther},
      {"1 2 3 4 5 6 7 8 9 10 11 12 13\n", ContentKind::kOther},
      {"frame,time_ns,state\n", ContentKind::kPoseTable},
      {"index,time_ns,status\n", ContentKind::kFrameTable},
      {"1.5 1 2 3 0 0 0 1\n", ContentKind::kTrajectory},
      {"{\"type\":\"FeatureCollection\",\"features\":[]}", ContentKind::kGeoJson},
      {"time_ns,x\n", ContentKind::kOther},
      {"P0: 1 0 0 0 0 1 0 0 0 0 1 0\n", ContentKind::kOther},
  };
  for (const auto& [content, kind] : cases) {
    EXPECT_EQ(content_kind_of(file("a", content)), kind) << content;
  }
  EXPECT_EQ(content_kind_of(map("a.fovea")), ContentKind::kMap);
  EXPECT_EQ(content_kind_of(folder_ / "none"), ContentKind::kOther);
}

TEST_F(CommandFilesTest, NoOutputIsAnInputUnderWhateverName) {
  const std::string input = map("m.fovea");
  std::filesystem::create_symlink(input, folder_ / "link.fovea");
  std::filesystem::create_hard_link(input, folder_ / "hard.fovea");
  for (const std::string& output :
       {input, path("link.fovea"), path("hard.fovea"), path("./m.fovea")}) {
    for (const ContentKind kind : {ContentKind::kMap, ContentKind::kReport, ContentKind::kPly}) {
      EXPECT_THAT(answer({{input}, {{output, kind, true}}}), HasSubstr("the command reads"));
    }
  }
  EXPECT_EQ(answer({{input}, {{path("other.fovea"), ContentKind::kMap}}}), kAccepted);
}

// A name that the output only uses while it grows.
TEST_F(CommandFilesTest, NoPartialFileIsAnInput) {
  const std::string input = map("out.fovea.partial");
  EXPECT_THAT(answer({{input}, {{path("out.fovea"), ContentKind::kMap}}}), HasSubstr("reads"));
  const std::string scan = file("out.ply.partial", kPly);
  EXPECT_THAT(answer({{scan}, {{path("out.ply"), ContentKind::kPly}}}), HasSubstr("reads"));
  const std::string log = file("a.fovea-wal", "log");
  EXPECT_THAT(answer({{log}, {{path("a.fovea"), ContentKind::kMap}}}), HasSubstr("reads"));
}

TEST_F(CommandFilesTest, NoOutputIsTheLogOfAMapThatIsRead) {
  const std::string input = map("m.fovea");
  file("m.fovea-wal", "");
  EXPECT_THAT(answer({{input}, {{path("m.fovea-wal"), ContentKind::kReport, true}}}),
              HasSubstr("a part of"));
}

TEST_F(CommandFilesTest, NoOutputIsAFileOfAnInputFolder) {
  const std::string scan = file("drive/scans/0.ply", kPly);
  const std::string elsewhere = file("archive/1.ply", kPly);
  std::filesystem::create_symlink(elsewhere, folder_ / "drive/scans/1.ply");
  std::filesystem::create_symlink(folder_ / "drive", folder_ / "drive/scans/loop");
  const std::string other = file("archive/2.ply", kPly);
  for (const std::string& output : {scan, elsewhere, path("archive/../drive/scans/1.ply")}) {
    EXPECT_THAT(answer({{path("drive")}, {{output, ContentKind::kPly, true}}}),
                HasSubstr("a file of the drive or folder"));
  }
  EXPECT_EQ(answer({{path("drive")}, {{other, ContentKind::kPly, true}}}), kAccepted);
  EXPECT_EQ(answer({{path("drive")}, {{map("drive/a.fovea"), ContentKind::kMap, true}}}), kAccepted)
      << "no drive has a map";
}

// KITTI's poses of a sequence lie outside of its folder.
TEST_F(CommandFilesTest, NoOutputIsThePoseFileOfASequence) {
  file("set/sequences/04/calib.txt", "P0: 1\n");
  const std::string poses = file("set/poses/04.txt", kPose),
                    other = file("set/poses/05.txt", kPose);
  const std::string sequence = path("set/sequences/04");
  EXPECT_THAT(answer({{sequence}, {{poses, ContentKind::kPoses, true}}}),
              HasSubstr("of the drive"));
  EXPECT_THAT(answer({{sequence + "/"}, {{poses, ContentKind::kPoses, true}}}),
              HasSubstr("of the drive"));
  EXPECT_EQ(answer({{sequence}, {{other, ContentKind::kPoses, true}}}), kAccepted);
}

TEST_F(CommandFilesTest, TwoOutputsAreTwoFiles) {
  const auto both = [&](const std::string& a, const std::string& b) {
    return answer({{}, {{a, ContentKind::kReport, true}, {b, ContentKind::kHtml, true}}});
  };
  EXPECT_THAT(both(path("a"), path("a")), HasSubstr("one file"));
  EXPECT_THAT(both(path("a"), path("./a")), HasSubstr("one file"));
  EXPECT_THAT(both(path("a"), path("a.partial")), HasSubstr("one file"));
  EXPECT_EQ(both(path("a"), path("b")), kAccepted);
  EXPECT_EQ(both("", ""), kAccepted);
}

TEST_F(CommandFilesTest, OnlyAFileOfTheSameKindIsReplaced) {
  const std::string a_map = map("m.fovea");
  EXPECT_THAT(answer({{}, {{path("m.fovea"), ContentKind::kMap, false}}}), HasSubstr("--force"));
  EXPECT_EQ(answer({{}, {{path("m.fovea"), ContentKind::kMap, true}}}), kAccepted);
  std::filesystem::rename(a_map, folder_ / "m");
  EXPECT_THAT(answer({{}, {{path("m"), ContentKind::kReport, true}}}),
              AllOf(HasSubstr("is a Fovea map"), HasSubstr("another name")));
  const std::string json = file("package.json", "{\"name\": 1}");
  EXPECT_THAT(answer({{}, {{json, ContentKind::kReport, true}}}), HasSubstr("no report"));
  const std::string notes = file("notes", "something dear");
  EXPECT_THAT(answer({{}, {{notes, ContentKind::kMap, true}}}), HasSubstr("of another kind"));
  const std::string report = file("r.json", "{\"map\": {}}"), empty = file("e.json", "");
  for (const std::string& output : {report, empty}) {
    EXPECT_EQ(answer({{}, {{output, ContentKind::kReport, true}}}), kAccepted);
  }
  EXPECT_THAT(answer({{}, {{"/dev/null", ContentKind::kReport, true}}}), HasSubstr("ordinary"));
}

TEST_F(CommandFilesTest, APartialFileIsReplacedUnlessItIsOfAnotherKind) {
  file("a.ply.partial", kPly);
  EXPECT_EQ(answer({{}, {{path("a.ply"), ContentKind::kPly}}}), kAccepted);
  EXPECT_THAT(answer({{}, {{path("a.ply"), ContentKind::kReport}}}),
              AllOf(HasSubstr("is a PLY file"), HasSubstr("a.ply.partial")));
  map("b.partial");
  EXPECT_THAT(answer({{}, {{path("b"), ContentKind::kLas}}}), HasSubstr("is a Fovea map"));
}

TEST_F(CommandFilesTest, AMapHasNoNameOfAnotherFormat) {
  for (const char* name : {"a.ply", "a.LAS", "a.json", "a.html"}) {
    EXPECT_THAT(answer({{}, {{path(name), ContentKind::kMap}}}), HasSubstr("ends in")) << name;
  }
  for (const char* name : {"a.fovea", "a", "a.db", "a.map", "2011.09.26"}) {
    EXPECT_EQ(answer({{}, {{path(name), ContentKind::kMap}}}), kAccepted) << name;
  }
  EXPECT_THAT(answer({{}, {{path("a.fovea"), ContentKind::kPly}}}), HasSubstr(".fovea"));
}

TEST_F(CommandFilesTest, NoOutputFolderLiesInAnInputOrReplacesOne) {
  file("drive/a", "");
  std::filesystem::create_symlink(folder_ / "drive", folder_ / "link");
  const auto folder = [&](const std::string& name, FolderUse use = FolderUse::kReplace) {
    return answer({{path("drive")}, {}, {path(name), use}});
  };
  for (const char* inside : {"drive", "drive/", "drive/out", "drive/../drive/out", "link/out"}) {
    EXPECT_THAT(folder(inside), HasSubstr("lies in")) << inside;
    EXPECT_THAT(folder(inside, FolderUse::kAddTo), HasSubstr("lies in")) << inside;
  }
  EXPECT_THAT(folder("."), HasSubstr("contains"));
  EXPECT_EQ(folder(".", FolderUse::kAddTo), kAccepted);
  EXPECT_EQ(folder("drive-2"), kAccepted) << "a name that only begins alike";
  EXPECT_EQ(folder("out"), kAccepted);
}

TEST_F(CommandFilesTest, NoOutputLiesInAFolderThatIsReplaced) {
  const auto both = [&](const std::string& output) {
    return answer(
        {{}, {{path(output), ContentKind::kReport, true}}, {path("out"), FolderUse::kReplace}});
  };
  for (const char* inside : {"out", "./out", "out/report.json"}) {
    EXPECT_THAT(both(inside), HasSubstr("at one place")) << inside;
  }
  EXPECT_EQ(both("out.json"), kAccepted);
}

}  // namespace fovea::command_files_test

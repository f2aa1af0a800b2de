// The power cut at any moment while a map grows: a file that was committed opens, whole.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <set>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/map_store.h"
#include "fovea/map/recording_vfs.h"

namespace fovea::power_loss_test {

constexpr int kCommits = 6;

/// What a run puts between one commit and the next: new, changed and removed rows.
void put_step(MapWriter& writer, int step) {
  Random random(std::uint64_t(step) + 1);
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  map.add(random_map_points(3000, random, 6.0));
  for (const auto& [key, tile] : map.submaps()[0].tiles) {
    writer.put_tile({std::size_t(step) / 2, key}, *tile.points);
  }
  if (step > 0) writer.remove_tile({std::size_t(step - 1) / 2, {0, 0, 0}});
  writer.put_submap(std::size_t(step) / 2, RigidMotion(Eigen::Translation3d(step, 0, 0)));
  FrameRecord frame = sample_frames()[0];
  frame.index = step;
  writer.put_frame(frame);
  if (step > 0) writer.put_pose(step - 1, RigidMotion(Eigen::Translation3d(step, 1, 0)));
  writer.put_meta("complete", step + 1 == kCommits ? "1" : "0");
}

/// Commits all steps from `first` on, the last as the end of the map.
void write_steps(MapWriter& writer, int first, const std::function<void()>& committed) {
  for (int step = first; step < kCommits; ++step) {
    put_step(writer, step);
    if (step + 1 == kCommits) {
      writer.finish();
    } else {
      writer.commit();
    }
    committed();
  }
}

TEST(PowerLoss, EveryCommitStaysAndTheMapGoesOn) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fovea", undisturbed = folder / "b.fovea";
  std::vector<std::string> digests;
  write_steps(*MapWriter::create(undisturbed, false), 0,
              [&] { digests.push_back(MapReader(undisturbed).digest()); });

  std::vector<RecordingVfs::Event> events;
  {
    RecordingVfs disk;
    write_steps(*MapWriter::create(path, false), 0, [&] { disk.mark(); });
    events = std::move(disk.events);
  }
  using Event = RecordingVfs::Event;
  const auto named = std::find_if(events.begin(), events.end(), [&](const Event& event) {
    return event.kind == Event::kOpen && event.file == path;
  });
  ASSERT_NE(named, events.end());
  const auto first = static_cast<std::size_t>(named - events.begin()) + 1;
  ASSERT_GT(events.size(), first + 300);

  Random random(1);
  std::set<std::string> seen;
  for (int trial = 0; trial < 600; ++trial) {
    const std::size_t cut = first + random.below(events.size() - first + 1);
    std::filesystem::remove_all(folder / "after");
    std::filesystem::create_directory(folder / "after");
    for (const auto& [name, content] : power_cut(events, cut, random)) {
      if (!name.starts_with(path)) continue;  // before it had its name
      std::ofstream(folder / ("after/map" + name.substr(path.size())), std::ios::binary)
          .write(content.data(), std::streamsize(content.size()));
    }
    const auto committed = static_cast<std::size_t>(
        std::count_if(events.begin(), events.begin() + std::ptrdiff_t(cut),
                      [](const Event& event) { return event.kind == Event::kMark; }));
    const auto after = folder / "after/map";
    SCOPED_TRACE(
        fmt::format("trial {}, cut after {} events and {} commits", trial, cut, committed));
    const std::string digest = MapReader(after).digest();
    const auto state = std::find(digests.begin(), digests.end(), digest);
    ASSERT_NE(state, digests.end());
    const auto commits = static_cast<std::size_t>(state - digests.begin()) + 1;
    ASSERT_GE(commits, committed);
    ASSERT_LE(commits, std::max(committed, std::size_t{1}) + 1);
    seen.insert(digest);
    if (trial % 20 > 0) continue;
    write_steps(*MapWriter::open(after), int(commits), [] {});
    ASSERT_EQ(MapReader(after).digest(), digests.back());
  }
  EXPECT_EQ(seen.size(), std::size_t(kCommits));
}

}  // namespace fovea::power_loss_test

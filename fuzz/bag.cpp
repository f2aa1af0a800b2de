// Recordings of ROS 2: MCAP, SQLite, and either compressed as a whole.
#include "fovea/rosbag/bag.h"

#include <fstream>
#include <set>

#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

class Listener : public BagSink {
 public:
  bool wants(const BagTopic& topic) override {
    const bool wanted = topic.name.size() % 2 == 0;
    if (wanted) wanted_.insert(topic.name);
    return wanted;
  }
  bool add(const BagTopic& topic, std::string_view message) override {
    require(wanted_.contains(topic.name), "only messages that are wanted come");
    require(topic.encoding == kCdrEncoding, "only messages of ROS 2 come");
    bytes_ += message.size();
    return bytes_ < 1'000'000;
  }

 private:
  std::set<std::string> wanted_;
  std::size_t bytes_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  const std::filesystem::path file = folder / "a.bag";
  std::ofstream(file, std::ios::binary) << as_text(data, size);
  read_or_refuse([&] {
    Listener listener;
    read_bag_file(file, listener);
  });
  return 0;
}

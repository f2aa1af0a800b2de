#include "fovea/drive/recordings/bag_index.h"

#include <fmt/format.h>

#include "fovea/drive/recordings/bag.h"
#include "fovea/drive/recordings/bag_indexer.h"
#include "fovea/errors.h"

namespace fovea {

std::string UnusableMessages::note(const std::string& topic) const {
  return fmt::format("{} messages of {} cannot be used (the first: {})", count, topic,
                     first_problem);
}

void check_stamp(const ros::Header& header) {
  if (header.stamp <= 0) throw InputError("it has no stamp", "", "");
}

void check_header(const ros::Header& header, const std::string& frame) {
  check_stamp(header);
  if (header.frame == frame) return;
  throw InputError(fmt::format("its frame is '{}', not '{}'", header.frame, frame), "", "");
}

BagIndex index_bags(const std::vector<std::filesystem::path>& files,
                    const std::filesystem::path& scratch) {
  BagIndexer indexer;
  for (const std::filesystem::path& file : files) read_bag_file(file, scratch, indexer);
  return indexer.finish();
}

}  // namespace fovea

#include "fovea/drive/recordings/sqlite_bag.h"

#include <map>

#include "fovea/core/sqlite_database.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr sqlite::FileWords kBagWords = {"recording", "not a recording of ROS 2",
                                         "give a .db3 file that 'ros2 bag record' wrote",
                                         "restore it from a copy"};

/// Without a log beside it nothing changes the file, and SQLite needs make no files of its own.
sqlite::Access access_of(const std::filesystem::path& file) {
  std::filesystem::path log = file;
  log += "-wal";
  std::error_code error;
  return std::filesystem::exists(log, error) ? sqlite::Access::kRead
                                             : sqlite::Access::kReadImmutable;
}

void check_tables(sqlite::Database& database) {
  constexpr const char* kTables =
      "SELECT COUNT(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')";
  if (database.integer(kTables) == 2) return;
  throw InputError("the database has no topics and messages", database.where(),
                   kBagWords.what_to_give);
}

}  // namespace

void read_sqlite_bag(const std::filesystem::path& file, const std::filesystem::path& shown,
                     BagSink& sink) {
  sqlite::Database database(file, access_of(file), shown, kBagWords);
  check_tables(database);
  struct Channel {
    BagTopic topic;
    bool wanted;
  };
  std::map<std::int64_t, Channel> channels;
  sqlite::Statement topics(database,
                           "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  while (topics.step()) {
    BagTopic topic{std::string(topics.text(1)), std::string(topics.text(2)),
                   std::string(topics.text(3))};
    const bool wanted = sink.is_requested(topic) && topic.encoding == kCdrEncoding;
    channels.emplace(topics.integer(0), Channel{std::move(topic), wanted});
  }
  // By their ids: in the file's own order, without sorting what may be a hundred gigabytes.
  sqlite::Statement messages(database, "SELECT topic_id, data FROM messages ORDER BY id");
  while (messages.step()) {
    const auto channel = channels.find(messages.integer(0));
    if (channel == channels.end()) continue;
    if (!channel->second.wanted) {
      sink.skip(channel->second.topic);
      continue;
    }
    const std::span<const std::byte> data = messages.blob(1);
    const std::string_view message(reinterpret_cast<const char*>(data.data()), data.size());
    sink.add(channel->second.topic, message);
  }
}

}  // namespace fovea

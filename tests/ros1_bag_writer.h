// Writes bags of ROS 1 record by record, right ones and wrong ones.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <utility>

#include "mcap_writer.h"

namespace fovea::ros1 {

using mcap::number;

inline std::string block(const std::string& bytes) {
  return number(std::uint32_t(bytes.size())) + bytes;
}
using FieldList = std::initializer_list<std::pair<const char*, std::string>>;
inline std::string fields(FieldList list) {
  std::string bytes;
  for (const auto& [name, value] : list) bytes += block(std::string(name) + "=" + value);
  return bytes;
}
inline std::string record(FieldList header, const std::string& data) {
  return block(fields(header)) + block(data);
}
inline std::string bag_header(std::uint64_t index_pos = 1) {
  return record({{"op", "\x03"},
                 {"index_pos", number(index_pos)},
                 {"conn_count", number(1u)},
                 {"chunk_count", number(1u)}},
                std::string(20, ' '));
}
inline std::string connection(std::uint32_t id, const std::string& topic,
                              const std::string& type = "pkg/Type") {
  return record({{"op", "\x07"}, {"conn", number(id)}, {"topic", topic}},
                fields({{"topic", topic}, {"type", type}, {"md5sum", "*"}}));
}
inline std::string message(std::uint32_t id, const std::string& bytes) {
  return record({{"op", "\x02"}, {"conn", number(id)}, {"time", std::string(8, '\0')}}, bytes);
}
inline std::string chunk(const std::string& records, const std::string& compression,
                         const std::string& stored) {
  return record({{"op", "\x05"},
                 {"compression", compression},
                 {"size", number(std::uint32_t(records.size()))}},
                stored);
}
inline std::string file_of(const std::string& records, std::uint64_t index_pos = 1) {
  return "#ROSBAG V2.0\n" + bag_header(index_pos) + records;
}

}  // namespace fovea::ros1

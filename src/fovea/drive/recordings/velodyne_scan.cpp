// Sources: VLP-16 User Manual 63-9243 Rev. E, sections 9.3 to 9.5 and appendix A.2; VLP-32C User
// Manual 63-9325 Rev. B, sections 9.3 to 9.5.
#include "fovea/drive/recordings/velodyne_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "fovea/drive/recordings/named_rows.h"
#include "fovea/errors.h"

namespace fovea::ros {
namespace {

constexpr std::size_t kPacketBytes = 1206, kBlocks = 12, kBlockBytes = 100, kReturns = 32;
constexpr double kFiring = 55.296e-6, kLaser = 2.304e-6;  // s, from one to the next
constexpr double kDegree = std::numbers::pi / 180;
constexpr int kTurn = 36000;  // steps of the azimuth

struct Laser {
  double elevation;    // degrees
  double azimuth = 0;  // degrees, to be added to that of the block
  double above = 0;    // m, of its origin over that of the LiDAR
};

struct Model {
  std::uint8_t product;
  const char* name;
  double range_step;          // m
  std::size_t at_once;        // lasers that fire at the same time
  std::vector<Laser> lasers;  // in the order of the packets
};

const std::vector<Model>& models() {
  static const std::vector<Model> kModels = {
      {0x22,
       "VLP-16",
       0.002,
       1,
       {{-15, 0, 0.0112},
        {1, 0, -0.0007},
        {-13, 0, 0.0097},
        {3, 0, -0.0022},
        {-11, 0, 0.0081},
        {5, 0, -0.0037},
        {-9, 0, 0.0066},
        {7, 0, -0.0051},
        {-7, 0, 0.0051},
        {9, 0, -0.0066},
        {-5, 0, 0.0037},
        {11, 0, -0.0081},
        {-3, 0, 0.0022},
        {13, 0, -0.0097},
        {-1, 0, 0.0007},
        {15, 0, -0.0112}}},
      {0x28, "VLP-32C", 0.004, 2, {{-25, 1.4},    {-1, -4.2},    {-1.667, 1.4}, {-15.639, -1.4},
                                   {-11.31, 1.4}, {0, -1.4},     {-0.667, 4.2}, {-8.843, -1.4},
                                   {-7.254, 1.4}, {0.333, -4.2}, {-0.333, 1.4}, {-6.148, -1.4},
                                   {-5.333, 4.2}, {1.333, -1.4}, {0.667, 4.2},  {-4, -1.4},
                                   {-4.667, 1.4}, {1.667, -4.2}, {1, 1.4},      {-3.667, -4.2},
                                   {-3.333, 4.2}, {3.333, -1.4}, {2.333, 1.4},  {-2.667, -1.4},
                                   {-3, 1.4},     {7, -1.4},     {4.667, 1.4},  {-2.333, -4.2},
                                   {-2, 4.2},     {15, -1.4},    {10.333, 1.4}, {-1.333, -1.4}}}};
  return kModels;
}

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// The numbers of a packet.
class Packet {
 public:
  explicit Packet(std::string_view bytes) : bytes_(bytes) {}

  bool is_whole() const {
    if (bytes_.size() != kPacketBytes) return false;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      if (number_at<std::uint16_t>(bytes_, block * kBlockBytes) != 0xeeff) return false;
      if (azimuth(block) >= kTurn) return false;
    }
    return true;
  }
  /// Hundredths of a degree, clockwise from ahead.
  int azimuth(std::size_t block) const {
    return number_at<std::uint16_t>(bytes_, block * kBlockBytes + 2);
  }
  /// In steps of the model; 0: nothing came back.
  int range(std::size_t block, std::size_t place) const {
    return number_at<std::uint16_t>(bytes_, block * kBlockBytes + 4 + 3 * place);
  }
  int intensity(std::size_t block, std::size_t place) const {
    return number_at<std::uint8_t>(bytes_, block * kBlockBytes + 6 + 3 * place);
  }
  /// Microseconds since the full hour, of its first firing.
  std::uint32_t time() const { return number_at<std::uint32_t>(bytes_, kBlocks * kBlockBytes); }
  /// Blocks of two follow each other, with the last and the strongest return of the same firings.
  bool has_two_returns() const { return number_at<std::uint8_t>(bytes_, kPacketBytes - 2) == 0x39; }
  std::uint8_t product() const { return number_at<std::uint8_t>(bytes_, kPacketBytes - 1); }

 private:
  std::string_view bytes_;
};

class PacketDecoder {
 public:
  PacketDecoder(const Model& model, NamedRows& rows) : model_(model), rows_(rows) {
    for (const Laser& laser : model.lasers) {
      ring_.push_back(std::count_if(model.lasers.begin(), model.lasers.end(),
                                    [&](const Laser& l) { return l.elevation < laser.elevation; }));
    }
  }

  /// @param begin  s, of its first firing from the stamp of the scan
  void decode(const Packet& packet, double begin) {
    const std::size_t stride = packet.has_two_returns() ? 2 : 1;
    const std::size_t lasers = model_.lasers.size(), firings = kReturns / lasers;
    const double block_duration = kFiring * double(firings);
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const double turn = turn_of_block(packet, block, stride);
      const std::size_t moment = block / stride;  // two blocks may be of the same firings
      for (std::size_t place = 0; place < kReturns; ++place) {
        const int range = packet.range(block, place);
        const bool is_second = block % stride == 1;
        if (range == 0 || (is_second && range == packet.range(block - 1, place))) continue;
        const std::size_t firing = place / lasers, laser = place % lasers;
        const std::size_t step = laser / model_.at_once;
        const double in_block = kFiring * double(firing) + kLaser * double(step);
        const double azimuth = 0.01 * (packet.azimuth(block) + turn * in_block / block_duration);
        const double time = begin + block_duration * double(moment) + in_block;
        add(laser, range, azimuth, packet.intensity(block, place), time);
      }
    }
  }

 private:
  /// Hundredths of a degree that the LiDAR turns during a block: up to the next azimuth, or as in
  /// the blocks before the last one. 0 where the azimuth jumps: a gap of the field of view, or a
  /// step back.
  static double turn_of_block(const Packet& packet, std::size_t block, std::size_t stride) {
    constexpr int kMostTurn = 200;  // at 20 turns a second a block of the VLP-16 takes 80
    const std::size_t from = std::min(block - block % stride, kBlocks - 2 * stride);
    const int turn = (packet.azimuth(from + stride) - packet.azimuth(from) + kTurn) % kTurn;
    return turn > kMostTurn ? 0 : turn;
  }

  void add(std::size_t laser, int range, double azimuth, int intensity, double time) {
    const Laser& by = model_.lasers[laser];
    const double turned = (azimuth + by.azimuth) * kDegree, elevation = by.elevation * kDegree;
    const double reach = range * model_.range_step, level = reach * std::cos(elevation);
    rows_.add(std::array<double, 6>{level * std::cos(turned), -level * std::sin(turned),
                                    reach * std::sin(elevation) + by.above, double(intensity),
                                    double(ring_[laser]), time});
  }

  const Model& model_;
  NamedRows& rows_;
  std::vector<std::ptrdiff_t> ring_;  // by laser
};

const Model& model_of(const Packet& packet, const std::string& where) {
  const std::uint8_t product = packet.product();
  const auto found = std::find_if(models().begin(), models().end(),
                                  [&](const Model& m) { return m.product == product; });
  if (found != models().end()) return *found;
  throw InputError(
      fmt::format("packets of the Velodyne with product number 0x{:02x} are not read", product),
      where, "run velodyne_pointcloud, and record its PointCloud2");
}

/// s, from one packet to another by the clock of the LiDAR, which starts again each hour.
double seconds_between(const Packet& first, const Packet& later) {
  constexpr double kHour = 3600;
  const double seconds = 1e-6 * (double(later.time()) - double(first.time()));
  return seconds - kHour * std::round(seconds / kHour);
}

}  // namespace

VelodyneScan read_velodyne_scan(MessageReader& message) {
  VelodyneScan scan;
  scan.header = read_header(message);
  scan.packets.resize(message.count(8 + kPacketBytes));
  for (VelodynePacket& packet : scan.packets) {
    packet.stamp = read_time(message);
    packet.data = message.block(kPacketBytes);
  }
  return scan;
}

void read_rows(const VelodyneScan& scan, const std::string& where, CloudRows& rows) {
  static const std::array<NamedColumn, 6> kColumns = {{{"x", Scalar::kFloat},
                                                       {"y", Scalar::kFloat},
                                                       {"z", Scalar::kFloat},
                                                       {"intensity", Scalar::kUint8},
                                                       {"ring", Scalar::kUint16},
                                                       {"time", Scalar::kFloat}}};
  if (scan.packets.empty()) {
    throw InputError("the scan has no packets", where, "restore the recording from a copy");
  }
  for (const VelodynePacket& packet : scan.packets) {
    if (Packet(packet.data).is_whole()) continue;
    throw InputError("a packet is damaged", where, "restore the recording from a copy");
  }
  const Packet first(scan.packets.front().data);
  const Model& model = model_of(first, where);
  for (const VelodynePacket& packet : scan.packets) {
    if (Packet(packet.data).product() == first.product()) continue;
    throw InputError("the packets of a scan are of different LiDARs", where,
                     "record each LiDAR on a topic of its own");
  }
  NamedRows named(kColumns, scan.packets.size() * kBlocks * kReturns, rows);
  PacketDecoder decoder(model, named);
  const double begin = seconds(scan.packets.front().stamp - scan.header.stamp);
  for (const VelodynePacket& packet : scan.packets) {
    decoder.decode(Packet(packet.data), begin + seconds_between(first, Packet(packet.data)));
  }
}

}  // namespace fovea::ros

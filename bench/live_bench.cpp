// What clients of a live view cost the mapper: a drive mapped again and again, in turns with nobody
// looking on, and with clients (three, of which one never reads).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/map_drive.h"
#include "fovea/server/live_map_server.h"
#include "fovea/server/web_client.h"

namespace {

using namespace fovea;

constexpr std::array kPage{PageFile{"index.html", "<html>"}};

/// Some that read all there is, and some that read nothing.
class Clients {
 public:
  Clients(int port, int reading, int deaf) {
    for (int i = 0; i < reading + deaf; ++i) {
      clients_.push_back(std::make_unique<WebClient>(port, i < reading ? 0 : 4096));
      if (clients_.back()->open_socket("/live") != 101) throw std::runtime_error("no WebSocket");
    }
    for (std::size_t i = 0; i < std::size_t(reading); ++i) {
      readers_.emplace_back([this, i] {
        while (!ended_) {
          const std::size_t count = clients_[i]->receive().size();
          if (count == 0) return;
          bytes_ += count;
        }
      });
    }
  }
  std::size_t bytes() const { return bytes_; }
  void end() { ended_ = true; }

 private:
  std::vector<std::unique_ptr<WebClient>> clients_;
  std::atomic<std::size_t> bytes_{0};
  std::atomic<bool> ended_{false};
  std::vector<std::jthread> readers_;
};

struct Run {
  double frames_per_second = 0;
  double megabytes = 0;  // that the clients have read
};

Run map_once(const std::shared_ptr<const FrameSource>& drive, const std::string& output,
             int reading, int deaf) {
  MapJob job;
  job.output = output;
  job.settings = load_preset("default");
  job.force = true;
  WebServerOptions server;
  server.in_background = true;
  LiveMapServer show(job, std::make_shared<DriveImages>(drive), kPage, server);
  job.observer = &show;
  const std::string url = show.url();
  std::unique_ptr<Clients> clients;
  if (reading + deaf > 0) {
    clients = std::make_unique<Clients>(std::stoi(url.substr(url.rfind(':') + 1)), reading, deaf);
  }
  Run run;
  run.frames_per_second = map_drive(*drive, job, {}).frames_per_second;
  if (clients) {
    run.megabytes = 1e-6 * double(clients->bytes());
    clients->end();
    show.finish();  // a last message, that wakes the readers
  }
  return run;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What clients of a live view cost the mapper");
  std::string drive, output = "live_bench.fovea";
  int runs = 11, reading = 2, deaf = 1;
  app.add_option("DRIVE", drive, "KITTI raw drive or odometry sequence")->required();
  app.add_option("-o,--output", output, "Map file, removed in the end")->capture_default_str();
  app.add_option("--reading", reading, "Clients that read all")->capture_default_str();
  app.add_option("--deaf", deaf, "Clients that never read")->capture_default_str();
  app.add_option("--runs", runs, "Of each kind")->capture_default_str()->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  try {
    const std::shared_ptr<const FrameSource> source = open_drive(drive, {});
    map_once(source, output, 0, 0);  // the page cache is warm for all
    std::vector<double> alone, watched, slower, megabytes;
    for (int i = 0; i < runs; ++i) {
      alone.push_back(map_once(source, output, 0, 0).frames_per_second);
      const Run run = map_once(source, output, reading, deaf);
      watched.push_back(run.frames_per_second);
      megabytes.push_back(run.megabytes);
      slower.push_back(100 * (alone.back() / watched.back() - 1));
    }
    std::filesystem::remove(output);
    fmt::print("nobody: {:.2f} frames/s; {} clients that read, {} that never do: {:.2f} frames/s, ",
               median(alone), reading, deaf, median(watched));
    fmt::print("{:.1f} MB read\n", median(megabytes));
    fmt::print("slower, median of {} pairs: {:.1f} %\n", runs, median(slower));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

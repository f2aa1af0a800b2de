#include "app/live_view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/interrupt.h"
#include "app/print.h"
#include "app/view_arguments.h"
#include "app/viewer_page.h"
#include "fovea/map/map_store.h"
#include "fovea/server/live_map_server.h"
#include "fovea/server/recent_images.h"

namespace fovea::app {
namespace {

/// Value of --live without a port.
constexpr const char* kSomePort = "some";

std::shared_ptr<FrameImages> images_of(std::shared_ptr<const FrameSource> drive) {
  if (drive->info().kind == kLiveDrive) return std::make_shared<RecentImages>(drive->info());
  return std::make_shared<DriveImages>(std::move(drive));
}

}  // namespace

void add_live_option(CLI::App& command, std::string& live) {
  command
      .add_flag(fmt::format("--live{{{}}}", kSomePort), live,
                fmt::format("Show the map in a browser while it grows, and after: --live or "
                            "--live=PORT (default: {}, or another if it is taken)",
                            kUsualPort))
      ->option_text("[=PORT]")
      ->check([](const std::string& port) {
        const bool is_port = port == kSomePort || CLI::Range(0, 65535)(port).empty();
        return is_port ? std::string() : port + " is no port: 0 to 65535";
      });
}

struct LiveView::Serving {
  MapJob& job;
  bool quiet;
  std::unique_ptr<LiveMapServer> show;
};

LiveView::LiveView(const std::string& live, MapJob& job, std::shared_ptr<const FrameSource> drive,
                   bool quiet) {
  if (live.empty()) return;
  WebServerOptions server;
  server.in_background = true;
  const auto images = images_of(std::move(drive));
  const int port = live == kSomePort ? -1 : std::stoi(live);
  std::unique_ptr<LiveMapServer> show;
  open_at_port(server, port, [&](const WebServerOptions& options) {
    show = std::make_unique<LiveMapServer>(job, images, viewer_page(), options);
  });
  job.observer = show.get();
  if (!quiet) {
    print_out("shown at {}\n", show->url());
    std::fflush(stdout);
  }
  serving_ = std::make_shared<Serving>(Serving{job, quiet, std::move(show)});
}

void LiveView::keep_serving() {
  if (serving_ == nullptr) return;
  LiveMapServer& show = *serving_->show;
  const MapJob& job = serving_->job;
  show.finish();
  if (!job.stop.stop_requested()) {
    if (!serving_->quiet) {
      print_out("the map is still shown at {} (Ctrl-C ends)\n", show.url());
      std::fflush(stdout);
    }
    wait_for(job.stop);
  }
  serving_->show.reset();
  fold_log(job.output);
}

}  // namespace fovea::app

// `fovea map --live`: shows the map in a browser while it grows. live_view.cpp needs the server;
// no_live_view.cpp takes its place in a build without it.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "fovea/pipeline/map_drive.h"

namespace fovea::app {

/// Adds --live. Without the server there is no such option, and `live` stays empty.
void add_live_option(CLI::App& command, std::string& live);

class LiveView {
 public:
  /// Serves the map and becomes the observer of the job. Does nothing if `live` is empty.
  /// @param live  value of --live
  /// @param job   must outlive this
  LiveView(const std::string& live, MapJob& job, std::shared_ptr<const FrameSource> drive,
           bool quiet);

  /// Serves the finished map until the job's stop is requested.
  void keep_serving();

 private:
  struct Serving;
  std::shared_ptr<Serving> serving_;  // null without --live
};

}  // namespace fovea::app

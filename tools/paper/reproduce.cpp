#include "tools/paper/reproduce.h"

#include <fmt/format.h>

#include <algorithm>

#include "fovea/core/output_file.h"
#include "fovea/core/path_name.h"
#include "fovea/errors.h"
#include "tools/paper/results_page.h"
#include "tools/paper/rows.h"

namespace fovea::paper {
namespace {

std::filesystem::path make_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed || !std::filesystem::is_directory(folder)) {
    throw OutputError("the folder cannot be made", folder.string(), "give another -o");
  }
  return folder;
}

/// The row with a report page: the pictures of one row are enough.
constexpr const char* kRowWithPage = "default";

}  // namespace

std::vector<std::string> drive_names(const std::vector<std::string>& drives) {
  std::vector<std::string> names;
  for (const std::string& drive : drives) {
    const std::string name = name_of(drive);
    const auto before = [&](const std::string& wanted) {
      return std::find(names.begin(), names.end(), wanted) != names.end();
    };
    std::string unique = name;
    for (int i = 2; before(unique); ++i) unique = fmt::format("{}-{}", name, i);
    names.push_back(unique);
  }
  return names;
}

std::vector<std::string> reproduce(const ReproduceJob& job) {
  for (const std::string& row : reproduced_rows()) check_row(row);  // an error in the first second
  make_folder(job.output);
  const int total = static_cast<int>(job.rows.size() * job.drives.size());
  int done = 0;
  std::vector<DriveResults> results;
  for (std::size_t i = 0; i < job.drives.size(); ++i) {
    const FrameSource& source = *job.drives[i];
    const DriveInfo& info = source.info();
    DriveResults drive{job.names[i], {}, info.end - info.begin, {}, time_upsampling(source)};
    for (const Camera& camera : info.calibration.cameras) drive.cameras.push_back(camera.index);
    const std::filesystem::path folder = make_folder(job.output / ("rows-" + drive.name));
    for (const std::string& row : job.rows) {
      const std::filesystem::path page =
          row == kRowWithPage ? job.output / report_file(drive.name) : std::filesystem::path();
      nlohmann::ordered_json result = run_row(source, row, folder, page);
      if (!result.is_null()) drive.rows.push_back(std::move(result));
      job.progress(++done, total, row);
    }
    results.push_back(std::move(drive));
  }
  OutputFile json(job.output / "results.json", /*force=*/true);
  OutputFile page(job.output / "results.md", /*force=*/true);
  page.stream() << write_results_page(results, job.mls, job.command, job.output);
  json.stream() << results_json(results).dump(2) << '\n';
  json.commit();
  page.commit();
  return results_warnings(results);
}

}  // namespace fovea::paper

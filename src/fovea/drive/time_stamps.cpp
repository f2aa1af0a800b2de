#include "fovea/drive/time_stamps.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>

#include "fovea/core/read_file.h"

namespace fovea {
namespace {

/// Takes `digits` decimal digits off the front of `text`.
std::optional<int> take_number(std::string_view& text, std::size_t digits) {
  if (text.size() < digits) return std::nullopt;
  int number = 0;
  for (const char c : text.substr(0, digits)) {
    if (c < '0' || c > '9') return std::nullopt;
    number = number * 10 + (c - '0');
  }
  text.remove_prefix(digits);
  return number;
}

bool take(std::string_view& text, char expected) {
  if (text.empty() || text.front() != expected) return false;
  text.remove_prefix(1);
  return true;
}

/// ".967930880" -> 967930880; nothing -> 0.
std::optional<TimeNs> parse_fraction(std::string_view text) {
  if (text.empty()) return 0;
  if (!take(text, '.') || text.empty()) return std::nullopt;
  TimeNs fraction = 0;
  TimeNs unit = kNsPerSecond;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    unit /= 10;  // 0 beyond nanoseconds
    fraction += unit * (c - '0');
  }
  return fraction;
}

std::optional<TimeNs> parse_time_in_seconds(std::string_view text) {
  constexpr double kLongestDrive = 1e9;  // s; keeps the nanoseconds within 64 bits
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 1 || !(std::abs(numbers->front()) < kLongestDrive)) {
    return std::nullopt;
  }
  return from_seconds(numbers->front());
}

std::string_view trim(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const std::size_t begin = text.find_first_not_of(kSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

template <class Parse>
TimeStamps read_stamps(const std::filesystem::path& file, Parse&& parse) {
  TimeStamps stamps;
  for (const std::string& line : read_lines(file)) {
    const std::string_view text = trim(line);
    stamps.times.push_back(text.empty() ? std::nullopt : parse(text));
    if (!text.empty() && !stamps.times.back()) {
      stamps.malformed.push_back(static_cast<int>(stamps.times.size()) - 1);
    }
  }
  remove_out_of_order(stamps);
  return stamps;
}

}  // namespace

bool TimeStamps::any() const {
  return std::any_of(times.begin(), times.end(), [](const auto& time) { return bool(time); });
}

void remove_out_of_order(TimeStamps& stamps) {
  // tails[n]: largest start of an increasing run of n + 1 stamps in what was seen from the back.
  std::vector<TimeNs> tails;
  std::vector<std::size_t> run_length(stamps.times.size());
  for (std::size_t i = stamps.times.size(); i-- > 0;) {
    if (!stamps.times[i]) continue;
    const auto tail = std::partition_point(tails.begin(), tails.end(),
                                           [&](TimeNs start) { return start > *stamps.times[i]; });
    run_length[i] = static_cast<std::size_t>(tail - tails.begin()) + 1;
    if (tail == tails.end()) {
      tails.push_back(*stamps.times[i]);
    } else {
      *tail = *stamps.times[i];
    }
  }
  std::size_t wanted = tails.size();
  TimeNs last = std::numeric_limits<TimeNs>::min();
  for (std::size_t i = 0; i < stamps.times.size(); ++i) {
    if (!stamps.times[i]) continue;
    if (wanted > 0 && run_length[i] == wanted && *stamps.times[i] > last) {
      last = *stamps.times[i];
      --wanted;
    } else {
      stamps.times[i].reset();
      stamps.out_of_order.push_back(static_cast<int>(i));
    }
  }
}

std::optional<TimeNs> parse_date_time(std::string_view text) {
  namespace chrono = std::chrono;
  const auto year = take_number(text, 4);
  if (!year || !take(text, '-')) return std::nullopt;
  const auto month = take_number(text, 2);
  if (!month || !take(text, '-')) return std::nullopt;
  const auto day = take_number(text, 2);
  if (!day || !take(text, ' ')) return std::nullopt;
  const auto hour = take_number(text, 2);
  if (!hour || !take(text, ':')) return std::nullopt;
  const auto minute = take_number(text, 2);
  if (!minute || !take(text, ':')) return std::nullopt;
  const auto second = take_number(text, 2);
  const auto fraction = second ? parse_fraction(text) : std::nullopt;
  const chrono::year_month_day date{chrono::year(*year), chrono::month(unsigned(*month)),
                                    chrono::day(unsigned(*day))};
  constexpr int kFirstYear = 1970, kLastYear = 2261;  // what 64 bits of nanoseconds hold
  if (!fraction || !date.ok() || *year < kFirstYear || *year > kLastYear || *hour > 23 ||
      *minute > 59 || *second > 59) {
    return std::nullopt;
  }
  const TimeNs days = chrono::sys_days(date).time_since_epoch().count();
  return (((days * 24 + *hour) * 60 + *minute) * 60 + *second) * kNsPerSecond + *fraction;
}

TimeStamps read_date_times(const std::filesystem::path& file) {
  return read_stamps(file, parse_date_time);
}

TimeStamps read_seconds(const std::filesystem::path& file) {
  return read_stamps(file, parse_time_in_seconds);
}

std::optional<double> median_period(const TimeStamps& stamps) {
  std::vector<TimeNs> steps;
  for (std::size_t i = 1; i < stamps.times.size(); ++i) {
    if (stamps.times[i - 1] && stamps.times[i]) {
      steps.push_back(*stamps.times[i] - *stamps.times[i - 1]);
    }
  }
  if (steps.empty()) return std::nullopt;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return seconds(*middle);
}

}  // namespace fovea

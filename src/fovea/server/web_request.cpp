#include "fovea/server/web_request.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

namespace fovea {
namespace {

bool is_number(std::string_view text, unsigned most) {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value <= most;
}

bool is_address(int family, std::string_view text) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  return inet_pton(family, std::string(text).c_str(), address.data()) == 1;
}

/// Drops ":PORT"; nothing if what follows the colon is no port.
std::optional<std::string_view> without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos || host.ends_with(']')) return host;
  if (!is_number(host.substr(colon + 1), 65535)) return std::nullopt;
  return host.substr(0, colon);
}

bool is_allowed(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-' ||
         c == '/';
}

/// nothing if it is wrong; a letter that need not be encoded may be.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    unsigned value = 0;
    if (i + 2 >= text.size()) return std::nullopt;
    const char* first = text.data() + i + 1;
    const auto [end, error] = std::from_chars(first, first + 2, value, 16);
    if (error != std::errc() || end != first + 2) return std::nullopt;
    decoded += static_cast<char>(value);
    i += 2;
  }
  return decoded;
}

}  // namespace

bool is_own_host(std::string_view host) {
  const std::optional<std::string_view> name = without_port(host);
  if (!name || name->empty()) return false;
  if (name->size() > 2 && name->front() == '[' && name->back() == ']') {
    return is_address(AF_INET6, name->substr(1, name->size() - 2));
  }
  constexpr std::string_view kLocal = "localhost";
  const bool local = std::equal(name->begin(), name->end(), kLocal.begin(), kLocal.end(),
                                [](char a, char b) { return std::tolower(a) == b; });
  return local || is_address(AF_INET, *name);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host;
}

std::optional<std::string> requested_path(std::string_view target) {
  std::optional<std::string> path = percent_decoded(target.substr(0, target.find('?')));
  if (!path || !path->starts_with('/')) return std::nullopt;
  path->erase(0, 1);
  if (!std::all_of(path->begin(), path->end(), is_allowed)) return std::nullopt;
  if (path->empty()) return path;
  for (std::size_t begin = 0; begin <= path->size();) {
    const std::size_t end = std::min(path->find('/', begin), path->size());
    const std::string_view part = std::string_view(*path).substr(begin, end - begin);
    if (part.empty() || part == "." || part == "..") return std::nullopt;
    begin = end + 1;
  }
  return path;
}

}  // namespace fovea

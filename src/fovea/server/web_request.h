// Decides which requests the server answers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fovea {

/// Whether a Host header names this machine: localhost, or the address of an interface with or
/// without a port. A name is refused: any site's name may lead here (DNS rebinding), an address
/// leads nowhere else.
bool is_own_host(std::string_view host);

/// Whether a request of that Origin header comes from a page of this very server.
/// @param host  the Host header
bool is_own_origin(std::string_view origin, std::string_view host);

/// The path of a request's target, decoded, without the first slash and without the query; nothing
/// if it is no path of ours: without a slash at its beginning, with a part that is empty, "." or
/// "..", with a character other than letters, digits and "._-/", or wrongly encoded.
std::optional<std::string> requested_path(std::string_view target);

}  // namespace fovea

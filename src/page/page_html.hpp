#pragma once

#include <string_view>

namespace graze {

/// Returns the page: one HTML file with its script and style inside. Empty if this build has none.
std::string_view page_html();

} // namespace graze

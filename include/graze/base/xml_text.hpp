#pragma once

#include <string>
#include <string_view>

namespace graze {

/// Returns the text for use inside an XML document: special characters are escaped, and characters that XML forbids
/// (control characters, bytes that are not UTF-8, the two noncharacters) become U+FFFD.
std::string xml_text(std::string_view text);

/// Returns an XML document written by another program so that it can be embedded in a CDATA section: characters that
/// XML forbids become U+FFFD, and "]]>" is escaped; the rest is unchanged.
std::string well_formed(std::string_view document);

} // namespace graze

#pragma once

#include <string>
#include <string_view>

namespace graze {

/// A text as a part of a document of XML: what means something there is escaped, and what XML has no place for (control
/// characters, bytes that are no UTF-8, the two codes that are no characters) is U+FFFD.
std::string xml_text(std::string_view text);

/// A document of XML as another program has written it: what XML has no place for is U+FFFD, and what would end a
/// section of it is escaped; all else stays.
std::string well_formed(std::string_view document);

} // namespace graze

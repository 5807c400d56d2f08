#pragma once

#include "graze/layout/layout_cell.hpp"

#include <cstdint>
#include <string>

namespace graze {

/// Serialises a library as a GDSII file (Stream format 6.0), with a database unit of 1 nm and a user unit of 1 um. All
/// dates are constant, so that equal libraries give equal bytes. Texts are records without geometry.
/// @throws InputError for a polygon of more than 8190 corners or a name of more than 32 letters
/// @throws InputError for a cell that is not before those that refer to it or has a duplicate name, a polygon with
/// fewer than 3 corners, a layer beyond 32767, a text or library name of more than 512 letters, heights and angles that
/// are not finite
/// @throws InputError for a coordinate that does not fit in 32 bits, or a height or angle too large for GDSII
std::string gds_stream(const LayoutLibrary& library);

/// Encodes a number in GDSII's format: sign, exponent of 16 in excess of 64, and 56 bits of a fraction. Numbers below
/// 16^-64 become 0. @throws InputError for one beyond 2^251
std::uint64_t gds_real(double value);

} // namespace graze

#pragma once

#include "graze/layout/layout_cell.hpp"

#include <cstdint>
#include <string>

namespace graze {

/// A library as a file of GDSII (Stream format 6.0), with a database unit of 1 nm and a user unit of 1 um. All dates
/// are the same, so that equal libraries are equal bytes. Texts are records without geometry.
/// @throws std::length_error for a polygon of more than 8190 corners or a name of more than 32 letters
/// @throws std::out_of_range for a coordinate that does not fit in 32 bits
std::string gds_stream(const LayoutLibrary& library);

/// A number as GDSII has it: sign, exponent of 16 in excess of 64, and 56 bits of a fraction.
std::uint64_t gds_real(double value);

} // namespace graze

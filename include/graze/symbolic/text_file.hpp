#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace graze {

/// Whole texts of models and studies; longer ones are a mistake or an attack.
inline constexpr std::size_t longest_model = std::size_t{16} << 20;
/// Of tables of numbers.
inline constexpr std::size_t longest_table = std::size_t{256} << 20;

/// Reads a file. Only plain files are read: a folder has no text, a device may never end, and a pipe may never begin.
/// @param what as in "model file"; @param most of its bytes
/// @throws InputError when it cannot be read, is no plain file, or is longer
std::string read_text_file(const std::string& path, std::string_view what, std::size_t most);

} // namespace graze

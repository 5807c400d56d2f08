#pragma once

namespace graze {

/// Opens /dev/null for standard streams that a shell has closed (`>&-`). Otherwise the first file that is opened would
/// get their descriptor, and output would be written into it. Reading then finds no input, messages are lost, and
/// writing output fails, so that an error is reported.
void open_standard_streams() noexcept;

} // namespace graze

#pragma once

namespace graze {

/// Gives input, output and messages a place where a shell has closed them (`>&-`). Otherwise the first file that is
/// opened would get their number, and what is said would be written into it. Nothing is read, messages go nowhere, and
/// writing output fails, so that it is told.
void open_standard_streams() noexcept;

} // namespace graze

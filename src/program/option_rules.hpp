#pragma once

#include <CLI/App.hpp>

namespace graze {

/// Checks combinations of options. @throws InputError when a given option has no effect beside the others
void refuse_useless_options(const CLI::App& app);

} // namespace graze

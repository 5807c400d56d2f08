#pragma once

#include <CLI/App.hpp>

namespace graze {

/// @throws InputError when one option of a command line makes another one useless
void refuse_useless_options(const CLI::App& app);

} // namespace graze

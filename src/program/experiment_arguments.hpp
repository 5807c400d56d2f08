#pragma once

#include "program/arguments.hpp"

namespace graze {

/// The commands of experiments: `bench` and `acquire`.
void declare_experiment_commands(CLI::App& app, Arguments& arguments);

} // namespace graze

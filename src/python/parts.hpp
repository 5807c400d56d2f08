#pragma once

#include "graze/study/part_exchange.hpp"
#include "graze/study/yield_part.hpp"
#include "python/binding.hpp"

#include <memory>

namespace graze::python {

/// For yields: has devices solved for by an executor; none without an exchange, for threads of this process to do it.
DevicesElsewhere devices_by(const std::shared_ptr<PartExchange>& parts);

} // namespace graze::python

#include "graze/symbolic/input_errors.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>

namespace graze {

void Mistakes::throw_noted() {
    const auto at = [](const InputError& error) { return std::tuple(error.place().line, error.place().column); };
    std::stable_sort(all_.begin(), all_.end(),
                     [&](const InputError& one, const InputError& other) { return at(one) < at(other); });
    const auto same = [](const InputError& one, const InputError& other) {
        return std::string_view(one.what()) == other.what();
    };
    all_.erase(std::unique(all_.begin(), all_.end(), same), all_.end());
    if (all_.size() > most)
        all_.erase(all_.begin() + most, all_.end());
    if (all_.size() > 1)
        throw InputErrors(all_);
    if (!all_.empty())
        throw InputError(all_.front());
}

} // namespace graze

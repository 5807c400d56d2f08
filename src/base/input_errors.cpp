#include "graze/base/input_errors.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>

namespace graze {

void Mistakes::note(const InputError& error) {
    const auto is_same = [&](const InputError& known) { return std::string_view(known.what()) == error.what(); };
    if (std::none_of(all_.begin(), all_.end(), is_same))
        all_.push_back(error);
}

void Mistakes::throw_noted() {
    std::vector<std::string> files;
    for (const InputError& error : all_)
        if (std::find(files.begin(), files.end(), error.place().file) == files.end())
            files.push_back(error.place().file);
    const auto at = [&](const InputError& error) {
        return std::tuple(std::find(files.begin(), files.end(), error.place().file), error.place().line,
                          error.place().column);
    };
    std::stable_sort(all_.begin(), all_.end(),
                     [&](const InputError& one, const InputError& other) { return at(one) < at(other); });
    if (all_.size() > most)
        all_.erase(all_.begin() + most, all_.end());
    if (all_.size() > 1)
        throw InputErrors(all_);
    if (!all_.empty())
        throw InputError(all_.front());
}

} // namespace graze

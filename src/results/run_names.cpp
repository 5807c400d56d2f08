#include "results/run_names.hpp"

#include "base/letter_case.hpp"

#include <fmt/format.h>

namespace graze {

void require_free_name(const std::string& name, bool branch, const std::vector<std::string>& others,
                       const Place& place) {
    // The table of orbits would have the same name as the view over all branches.
    if (branch && in_small_letters(name) == "points")
        throw InputError(place,
                         fmt::format("no branch can be called '{}': result files have a view of that name", name),
                         "give it another name");
    for (const std::string& other : others)
        if (other != name && in_small_letters(other) == in_small_letters(name))
            throw InputError(place, fmt::format("the names of the runs '{}' and '{}' differ in case only", other, name),
                             "give one of them another name");
}

} // namespace graze

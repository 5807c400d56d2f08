#include "design/design_reader.hpp"

#include "graze/base/with_place.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <tuple>

namespace graze {

void WantedReader::read_value(const TomlEntry& item) {
    if (item.node->is_array())
        std::tie(wanted_.least, wanted_.greatest) = reader_.range(design_.model, item);
    else
        wanted_.value = number(item);
    // The finished device is approached as the first one, and must not start beyond its touch. A trip value beyond the
    // other end is reported when a device reaches it.
    const Approach& approach = design_.approach;
    const std::optional<double> greatest = wanted_.value ? wanted_.value : wanted_.greatest;
    if (approach.study.empty() && approach.least < approach.greatest && greatest && *greatest < approach.least)
        reader_.fail(item,
                     fmt::format("{} is below approach.range, from {:g} to {:g}: a device that trips there has tripped "
                                 "where its approach begins",
                                 item.path, approach.least, approach.greatest),
                     "let approach.range begin below what is wanted");
}

void WantedReader::read_trip_time(const TomlEntry& item) {
    reader_.read_keys(item, {{"overshoot", reader_.into(wanted_.overshoot, design_.model, positive_number)},
                             {"longest", reader_.into(wanted_.longest_time, design_.model, positive_number)}});
    if (!wanted_.overshoot || !wanted_.longest_time)
        reader_.fail(item, fmt::format("{} is not complete", item.path),
                     "write { overshoot = A, longest = B }: the greatest time at that overshoot");
}

void WantedReader::read_sensitivity(const TomlEntry& item) {
    reader_.each_of(item, {}, [&](const TomlEntry& one) {
        const ParameterId parameter =
            with_place(one.place, [&] { return design_.model.independent_parameter(one.name); });
        wanted_.sensitivities.emplace_back(parameter, reader_.positive(design_.model, one));
    });
}

void WantedReader::read_yield(const TomlEntry& item) {
    wanted_.yield_place = reader_.toml().place(*item.node);
    const double share = number(item);
    if (!(share > 0 && share <= 1))
        reader_.fail(item, fmt::format("the yield {:.6g} is not a share of devices above 0", share),
                     "give the least share of devices that will do, up to 1, as 0.95 for 95 percent");
    if (!design_.dimensions.empty() && // otherwise they were invalid, which has been reported
        std::ranges::none_of(design_.dimensions,
                             [](const DesignDimension& one) { return one.tolerance && one.tolerance->size > 0; }))
        reader_.fail(item, "a yield is wanted, and no dimension has a tolerance",
                     "give dimensions.NAME.tolerance, as \"1%\"");
    wanted_.least_yield = share;
}

void WantedReader::read_importance(const TomlEntry& item) {
    reader_.each_of(
        item, {"value", "class", "trip_time", "reset", "clear", "sensitivity", "yield"}, [&](const TomlEntry& one) {
            constexpr double most = 100; // larger weights would conflict with the tolerance of 1e-9
            const double times = reader_.positive(design_.model, one);
            if (!(times >= 1 / most && times <= most))
                reader_.fail(one, fmt::format("{} is {:.6g}", one.path, times),
                             fmt::format("give from {} to {}: how many times a miss counts", 1 / most, most));
            wanted_.importance.emplace_back(one.name, times);
        });
}

void WantedReader::read(const TomlEntry& entry) {
    constexpr GrazingOutcome outcomes[] = {GrazingOutcome::lost, GrazingOutcome::persists, GrazingOutcome::folds};
    reader_.read_keys(entry, {{"value", [&](const TomlEntry& item) { read_value(item); }},
                              {"class",
                               [&](const TomlEntry& item) {
                                   wanted_.outcome = outcomes[reader_.choice(item, {"trips", "persists", "folds"})];
                               }},
                              {"trip_time", [&](const TomlEntry& item) { read_trip_time(item); }},
                              {"reset",
                               [&](const TomlEntry& item) {
                                   std::tie(wanted_.least_reset, wanted_.greatest_reset) =
                                       reader_.range(design_.model, item);
                                   wanted_.reset_place = reader_.toml().place(*item.node);
                               }},
                              {"clear", reader_.into(wanted_.clear, design_.model, positive_number)},
                              {"sensitivity", [&](const TomlEntry& item) { read_sensitivity(item); }},
                              {"yield", [&](const TomlEntry& item) { read_yield(item); }},
                              {"importance", [&](const TomlEntry& item) { read_importance(item); }}});
    if (const auto& yield = wanted_.yield_place; wanted_.least_yield && !design_.least_usable())
        throw InputError(yield, "a yield is wanted, and nothing says which trip values will do",
                         "give yield.within = [A, B], or wanted.value = [A, B]");
}

} // namespace graze

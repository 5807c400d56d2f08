#include "page/orbit_facts.hpp"

#include "graze/results/stored_orbit.hpp"

namespace graze {

nlohmann::json orbit_facts(const RunRecord& run, const OrbitRecord& record) {
    return {{"number", record.number},
            {"label", record.label},
            {"name", run.point_name(record.label)},
            {"type", short_name(record.point.type)},
            {"type_words", name_of(record.point.type)},
            {"detail", record.point.detail},
            {"part", record.part},
            {"located", record.point.located},
            {"stable", record.stable},
            {"unphysical", is_unphysical(record)}};
}

} // namespace graze

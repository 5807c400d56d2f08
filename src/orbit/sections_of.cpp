#include "orbit/sections_of.hpp"

#include "graze/trajectory/probe.hpp"

#include <algorithm>

namespace graze {

std::vector<std::size_t> sections_of(const Model& model, const Signature& signature) {
    std::vector<std::size_t> sections;
    for (std::size_t s = 0; s < model.sections.size(); ++s)
        if (std::ranges::any_of(signature,
                                [&](const Segment& one) { return one.end == SegmentEnd::section && one.index == s; }))
            sections.push_back(s);
    return sections;
}

std::vector<Probe> probes_of(const Model& model, const Signature& signature) {
    std::vector<Probe> probes;
    for (const std::size_t section : sections_of(model, signature))
        probes.push_back(section_probe(model, model.sections[section].name));
    return probes;
}

} // namespace graze

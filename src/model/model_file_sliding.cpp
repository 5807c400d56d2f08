#include "model/model_file_sliding.hpp"

#include "graze/base/input_error.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

namespace graze {

void SlidingParts::name_slides(const TomlEntry& group) {
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        places_.set(entry.path, entry.place);
        Slide& slide = model_.slides.emplace_back();
        slide.name = entry.name;
        for (const TomlEntry& part : reader_.entries(reader_.table(entry), entry.path))
            if (part.name == "control") {
                places_.set(part.path, reader_.place(*part.node));
                slide.control = reader_.line(part);
            }
    }
}

void SlidingParts::name_frictions(const TomlEntry& group) {
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        places_.set(entry.path, entry.place);
        model_.frictions.emplace_back().name = entry.name;
    }
}

void SlidingParts::read_slides(const TomlEntry& group) {
    auto slide = model_.slides.begin();
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        Slide& one = *slide++;
        mistakes_.attempt([&] { read_slide(entry, one); });
    }
}

void SlidingParts::read_slide(const TomlEntry& entry, Slide& slide) {
    std::optional<std::size_t> surface;
    std::vector<std::size_t> between;
    const auto read_between = [&](const TomlEntry& part) {
        places_.set(part.path, part.place);
        for (const TomlEntry& mode : reader_.elements(part))
            between.push_back(index(mode, model_.modes, "mode"));
        if (between.size() != 2)
            throw InputError(reader_.place(*part.node), fmt::format("{} has {} modes", part.path, between.size()),
                             "name two: that in which the surface's function is negative, then that in which it is "
                             "positive");
    };
    const auto read_watch = [&](const TomlEntry& part) {
        places_.set(part.path, part.place);
        slide.watched.emplace();
        for (const TomlEntry& event : reader_.elements(part))
            slide.watched->push_back(index(event, model_.events, "event"));
    };
    const auto read_convention = [&](const TomlEntry& part) {
        slide.convention =
            choice(part, {"filippov", "utkin"}) == 0 ? SlideConvention::filippov : SlideConvention::utkin;
    };
    read_parts(entry, {{"surface", index_into(surface, model_.events, "event")},
                       {"between", read_between},
                       {"convention", read_convention},
                       {"control", [](const TomlEntry&) {}}, // known from `name_slides`
                       {"watch", read_watch},
                       {"text", text_into(slide.text)}});
    if (!surface)
        fail_missing(entry, "surface", "surface");
    if (between.empty())
        fail_missing(entry, "modes", "between");
    slide.surface = *surface;
    slide.left = between[0];
    slide.right = between[1];
}

void SlidingParts::read_frictions(const TomlEntry& group) {
    auto friction = model_.frictions.begin();
    for (const TomlEntry& entry : reader_.entries(reader_.table(group), group.path)) {
        Friction& one = *friction++;
        mistakes_.attempt([&] { read_friction(entry, one); });
    }
}

void SlidingParts::read_friction(const TomlEntry& entry, Friction& friction) {
    read_parts(entry, {{"velocity", expression_into(friction.velocity)},
                       {"normal", expression_into(friction.normal)},
                       {"coefficient", expression_into(friction.coefficient)},
                       {"static", [&](const TomlEntry& part) { friction.static_coefficient = expression(part); }},
                       {"text", text_into(friction.text)}});
    if (friction.velocity.empty())
        fail_missing(entry, "velocity", "velocity");
    if (friction.normal.empty())
        fail_missing(entry, "normal force", "normal");
    if (friction.coefficient.empty())
        fail_missing(entry, "coefficient", "coefficient");
}

} // namespace graze

// Sliding modes: the motion along a surface at which two modes meet (Filippov 1988; Utkin 1992; di Bernardo, Budd,
// Champneys and Kowalczyk 2008, chapter 8).

#include "graze/base/input_error.hpp"
#include "model/corner_modes.hpp"
#include "model/model_completion.hpp"
#include "model/model_expand.hpp"
#include "model/slide_corners.hpp"
#include "model/slide_events.hpp"
#include "model/surface_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace graze {

namespace {

/// One surface: the events at which it is met from both sides, and the jump onto it.
struct SlidingSide {
    std::size_t mode = 0;
    std::size_t meets = 0;           ///< the event at which this side meets the surface
    std::vector<Expression> field{}; ///< expanded
    Expression approach{};           ///< rate of the surface's function along the field
};

class SlideCompleter {
public:
    SlideCompleter(Model& model, const Places& places)
        : model_(model), places_(places), expander_(model), motion_(model, expander_), events_(model, places, motion_) {
    }

    void run() {
        for (const Slide& slide : model_.slides)
            check(slide);
        for (const Slide& slide : model_.slides)
            meet(slide);
        const std::vector<Slide> slides = model_.slides; // modes and events are added while they are completed
        const std::vector<SlideCorner> corners = corners_of(model_);
        set_controls(slides);
        for (const Slide& slide : slides)
            complete(slide);
        CornerModes at_corners(model_, places_, motion_, events_);
        for (const SlideCorner& corner : corners)
            at_corners.add_ways(corner);
        for (const Slide& slide : slides)
            events_.watch_others(slide);
        for (const SlideCorner& corner : corners)
            at_corners.complete(corner);
    }

private:
    [[noreturn]] void fail(const Slide& slide, const char* key, const std::string& problem,
                           const std::string& remedy) const {
        throw InputError(places_.of("slides." + slide.name + "." + key), problem, remedy);
    }
    const std::string& mode_name(std::size_t mode) const { return model_.modes[mode].name; }
    const std::string& event_name(std::size_t event) const { return model_.events[event].name; }

    void check(const Slide& slide) {
        if (model_.events[slide.surface].kind == EventKind::section)
            fail(slide, "surface", fmt::format("the surface '{}' is a section", event_name(slide.surface)),
                 "make it a barrier: leave its kind out");
        if (slide.left == slide.right)
            fail(slide, "between", fmt::format("the slide '{}' is between a mode and itself", slide.name),
                 "name the mode in which the function is negative, then that in which it is positive");
        for (const std::size_t mode : {slide.left, slide.right})
            if (model_.modes[mode].derived)
                fail(slide, "between",
                     fmt::format("the slide '{}' is between '{}', which a declaration makes", slide.name,
                                 mode_name(mode)),
                     "name two modes with rates of their own; where surfaces of slides meet the motion ends");
        if (!motion_.depends_on_states(motion_.expanded(model_.events[slide.surface].function)))
            fail(slide, "surface",
                 fmt::format("the surface '{}' does not depend on a state", event_name(slide.surface)),
                 "give a function of states");
        const bool utkin = slide.convention == SlideConvention::utkin;
        if (utkin == slide.control.empty())
            fail(slide, "control",
                 utkin ? fmt::format("the slide '{}' has no control", slide.name)
                       : fmt::format("the slide '{}' has a control, which belongs to the convention of Utkin",
                                     slide.name),
                 utkin ? "name it: control = \"u\", which is -1 in the first mode and 1 in the second"
                       : "add convention = \"utkin\", or leave it out");
    }

    /// Makes the modes of both sides watch the surface.
    void meet(const Slide& slide) {
        const std::string path = "slides." + slide.name;
        const Event surface = model_.events[slide.surface];
        const std::size_t rising = derived_event(model_, places_, path,
                                                 {.name = events_.rising_name(slide),
                                                  .text = fmt::format("'{}' from the other side", surface.name),
                                                  .function = -surface.function});
        for (const std::size_t mode : {slide.left, slide.right})
            for (const std::size_t event : {slide.surface, rising})
                if (model_.find_transition(mode, event) != nullptr)
                    fail(slide, "between",
                         fmt::format("mode '{}' has a transition for '{}' already", mode_name(mode),
                                     event_name(slide.surface)),
                         fmt::format("leave it out: the slide '{}' makes it", slide.name));
        watch_in_place_of(slide.left, slide.surface, rising);
        watch_in_place_of(slide.right, slide.surface, slide.surface);
        for (const auto& [mode, event, other] :
             {std::tuple(slide.left, rising, slide.surface), std::tuple(slide.right, slide.surface, rising)}) {
            if (!events_.add_meeting(mode, event) || events_.meets(mode, other))
                fail(slide, "between",
                     fmt::format("two slides have mode '{}' at the surface '{}'", mode_name(mode), surface.name),
                     "keep one: a mode has one neighbour at a surface");
        }
    }

    /// The name of a surface in the list of a mode stands for its passage from the side of this mode.
    void watch_in_place_of(std::size_t mode, std::size_t surface, std::size_t event) {
        std::vector<std::size_t>& watched = model_.modes[mode].watched;
        if (const auto place = std::ranges::find(watched, surface); place != watched.end())
            *place = event;
        else if (std::ranges::find(watched, event) == watched.end())
            watched.push_back(event);
    }

    /// The fields of both sides and of the motion along the surface.
    struct Fields {
        SlidingSide left, right;
        std::vector<Expression> sliding{};
    };

    /// Gives controls their values in the modes of both sides; the equations with their controls are kept.
    void set_controls(const std::vector<Slide>& slides) {
        std::map<std::size_t, std::map<std::string, double>> values; // for each mode
        for (const Slide& slide : slides)
            if (slide.convention == SlideConvention::utkin)
                for (const std::size_t mode : {slide.left, slide.right})
                    if (const double value = mode == slide.left ? -1 : 1;
                        values[mode].emplace(slide.control, value).first->second != value)
                        fail(slide, "control",
                             fmt::format("the control '{}' is both -1 and 1 in mode '{}'", slide.control,
                                         mode_name(mode)),
                             "give each surface a control of its own, and name the modes of a slide in the same order");
        const auto with_values = [&](std::size_t mode, const std::string& without) {
            std::vector<Replacement> replacements;
            for (const auto& [control, value] : values[mode])
                if (control != without)
                    replacements.emplace_back(model_.symbol(control), model_.number(value));
            return substitute(model_.modes[mode].rates, replacements);
        };
        for (const Slide& slide : slides)
            if (slide.convention == SlideConvention::utkin) {
                common_[slide.name] = with_values(slide.left, slide.control);
                require_one_equation(slide, with_values(slide.right, slide.control));
            }
        for (const auto& one : values)
            model_.modes[one.first].rates = with_values(one.first, "");
    }

    void require_one_equation(const Slide& slide, const std::vector<Expression>& other) const {
        const std::vector<Expression>& rates = common_.at(slide.name);
        for (std::size_t i = 0; i < rates.size(); ++i)
            if (!(rates[i] == other[i]))
                fail(slide, "control",
                     fmt::format("the rates of '{}' in '{}' and '{}' differ", model_.states[i].name,
                                 mode_name(slide.left), mode_name(slide.right)),
                     fmt::format("write the same rates in both modes, with '{}' for what differs", slide.control));
        const Expression control = model_.symbol(slide.control);
        if (std::ranges::none_of(rates, [&](const Expression& rate) { return contains_symbol(rate, control); }))
            fail(slide, "control",
                 fmt::format("the rates of '{}' do not contain the control '{}'", mode_name(slide.left), slide.control),
                 "write it for -1 in the first mode and 1 in the second");
    }

    Fields fields_of(const Slide& slide, const Expression& function) {
        Fields made;
        made.left.mode = slide.left;
        made.left.meets = *model_.find_event(events_.rising_name(slide));
        made.right.mode = slide.right;
        made.right.meets = slide.surface;
        for (auto* side : {&made.left, &made.right}) {
            side->field = motion_.expanded(model_.modes[side->mode].rates);
            side->approach = motion_.rate_along(function, side->field);
        }
        if (made.left.approach == made.right.approach)
            fail(slide, "between",
                 fmt::format("'{}' and '{}' cross the surface '{}' at the same rate, so that nothing slides",
                             mode_name(slide.left), mode_name(slide.right), event_name(slide.surface)),
                 "leave the slide out, and write the transitions");
        made.sliding = slide.convention == SlideConvention::utkin ? with_equivalent_control(slide, function)
                                                                  : with_filippovs_share(made.left, made.right);
        return made;
    }

    /// Returns the combination of both fields that is tangent to the surface (Filippov).
    static std::vector<Expression> with_filippovs_share(const SlidingSide& left, const SlidingSide& right) {
        return combined(left.field, right.field, left.approach / (left.approach - right.approach));
    }

    /// Returns the field with the value of the control at which it is tangent to the surface (Utkin).
    std::vector<Expression> with_equivalent_control(const Slide& slide, const Expression& function) {
        const std::vector<Expression> common = motion_.expanded(common_.at(slide.name));
        const Expression control = model_.symbol(slide.control), rate = motion_.rate_along(function, common);
        const Expression slope = differentiate(rate, control);
        if (contains_symbol(slope, control))
            fail(slide, "control",
                 fmt::format("the rate of the surface '{}' is not linear in the control '{}'",
                             event_name(slide.surface), slide.control),
                 "use the convention of Filippov, or a control in which it is");
        const Expression rest = substitute(rate, std::vector<Replacement>{{control, model_.number(0)}});
        return substitute(common, std::vector<Replacement>{{control, -rest / slope}});
    }

    void complete(const Slide& slide) {
        const std::string path = "slides." + slide.name;
        const Expression function = motion_.expanded(model_.events[slide.surface].function);
        Fields fields = fields_of(slide, function);
        motion_.leave_surfaces();
        motion_.add_surface(function, differing(fields.left.field, fields.right.field));
        const std::size_t sliding = *model_.find_mode(slide.name);
        model_.modes[sliding].text = slide.text;
        model_.modes[sliding].rates = motion_.tangent(fields.sliding);
        const Expression from_left = motion_.on_surface(fields.left.approach),
                         from_right = -motion_.on_surface(fields.right.approach);
        const std::size_t onto = derived_jump(
            model_, places_, path,
            {.name = "onto-" + event_name(slide.surface),
             .text = fmt::format("the state is put onto the surface of '{}' exactly", event_name(slide.surface)),
             .map = motion_.projection(function)});
        add_meeting(slide, fields.right, onto, from_left, fields.left.mode, sliding);
        add_meeting(slide, fields.left, onto, from_right, fields.right.mode, sliding);
        const bool stays = motion_.stays(function, model_.modes[sliding].rates);
        SlidingSurface along{.surface = slide.surface};
        along.exits = {add_exit(slide, from_left, slide.left, stays ? 0 : onto, sliding),
                       add_exit(slide, from_right, slide.right, stays ? 0 : onto, sliding)};
        model_.modes[sliding].slides_on = {along};
    }

    /// Adds what happens when one side meets the surface: sliding if the other side pushes back, crossing otherwise.
    void add_meeting(const Slide& slide, const SlidingSide& side, std::size_t onto, const Expression& push,
                     std::size_t other, std::size_t sliding) {
        Transition transition{.label = mode_name(side.mode) + ":" + event_name(slide.surface),
                              .mode = side.mode,
                              .event = side.meets,
                              .jump = onto,
                              .derived = true};
        transition.next = {{.when = {{push, false}}, .when_text = mode_name(other) + " pushes back", .mode = sliding},
                           {.mode = other}};
        model_.transitions.push_back(std::move(transition));
    }

    /// Adds the end of sliding where a side no longer pushes towards the surface. @return its event
    std::size_t add_exit(const Slide& slide, const Expression& push, std::size_t side, std::size_t jump,
                         std::size_t sliding) {
        const std::size_t event =
            derived_event(model_, places_, "slides." + slide.name,
                          {.name = slide.name + "-" + mode_name(side),
                           .text = fmt::format("'{}' no longer pushes towards the surface", mode_name(side)),
                           .function = push});
        model_.transitions.push_back({.label = slide.name + ":" + mode_name(side),
                                      .mode = sliding,
                                      .event = event,
                                      .jump = jump,
                                      .next = {{.mode = side}},
                                      .derived = true});
        return event;
    }

    Model& model_;
    const Places& places_;
    Expander expander_;
    SurfaceMotion motion_;
    SlideEvents events_;
    std::map<std::string, std::vector<Expression>> common_; ///< rates with the control of a slide, by its name
};

} // namespace

void complete_slides(Model& model, const Places& places) {
    if (!model.slides.empty())
        SlideCompleter(model, places).run();
}

} // namespace graze

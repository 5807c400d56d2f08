// Several events on one surface: relays without hysteresis, pulses, sections that coincide with a barrier.

#include "closed_form.hpp"
#include "model_parts.hpp"

#include <gtest/gtest.h>

using namespace graze;
using namespace graze::testing;

namespace shared_surface_test {

/// u = +1 or -1 is the state of the relay; `force` drives it.
Model relay(const std::string& kind, const std::string& states, const std::string& plus, const std::string& minus) {
    return model_from(fmt::format("name = \"relay\"\nparameters = {{ width = 0, scale = 1 }}\nstates = {{ {} }}\n"
                                  "[events]\n"
                                  "off = {{ function = \"width - x\", kind = \"{}\" }}\n"
                                  "on = {{ function = \"scale*(x + width)\", kind = \"{}\" }}\n"
                                  "[modes]\nplus = {{ rates = {{ {} }}, watch = [\"off\"] }}\n"
                                  "minus = {{ rates = {{ {} }}, watch = [\"on\"] }}\n[initial]\nmode = \"plus\"\n",
                                  states, kind, kind, plus, minus) +
                      transition("plus", "off", "minus") + transition("minus", "on", "plus"));
}

TEST(SharedSurface, AnIdealRelayWithoutAdmissibleModeMakesNoProgress) {
    Random random(51);
    for (int i = 0; i < 200; ++i) {
        const std::string kind = random.chance(0.5) ? "section" : "barrier";
        Model model = relay(kind, "x = -1", "x = \"scale\"", "x = \"-2*scale\"");
        const double scale = random.log_uniform(1e-9, 1e9), from = -random.log_uniform(1e-6, 1e6);
        model.set_parameter("scale", scale);
        Experiment experiment(model, with_tolerance(random.log_uniform(1e-15, 1e-6)));
        const double time = -from / scale;
        const Outcome outcome = experiment.run_from({from}, 0, 3 * time);
        EXPECT_EQ(outcome.ending, Ending::no_progress) << kind << " " << scale << " " << from;
        EXPECT_NEAR(outcome.time, time, 1e-14 * time);
    }
}

TEST(SharedSurface, ARelayWithAndWithoutHysteresisSwitchesAtEachPassage) {
    // x'' = -1 or 1: half waves of 4 sqrt(...) each; with hysteresis they grow, without it they repeat.
    Random random(52);
    for (int i = 0; i < 200; ++i) {
        const std::string kind = random.chance(0.5) ? "section" : "barrier";
        Model model = relay(kind, "x = -1, v = 0", "x = \"v\", v = 1", "x = \"v\", v = -1");
        const double start = random.log_uniform(1e-3, 1e3), unit = std::sqrt(start);
        model.set_parameter("scale", random.log_uniform(1e-9, 1e9));
        Experiment experiment(model, with_tolerance(random.log_uniform(1e-15, 1e-6)));
        const Outcome outcome = experiment.run_from({-start, 0}, 0, 40 * unit);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        const auto& contacts = experiment.recorder.contacts();
        ASSERT_EQ(contacts.size(), 14U) << kind << " " << start; // at sqrt(2) (1 + 2 k), k = 0..13
        for (std::size_t k = 0; k < contacts.size(); ++k)
            EXPECT_NEAR(contacts[k].contact.time, unit * std::sqrt(2.0) * (1.0 + 2.0 * static_cast<double>(k)),
                        1e-12 * unit * (1.0 + static_cast<double>(k)));
    }
}

TEST(SharedSurface, OneFallIsHandledOnceByTwoSections) {
    // Two modes alternate at each fall of sin(theta): each watches its own section, with the same function.
    Random random(53);
    for (int i = 0; i < 100; ++i) {
        const double rate = random.log_uniform(1e-9, 1e9), theta = random.uniform(0, 6.28);
        Model model = model_from(fmt::format(
            "name = \"pulses\"\nparameters = {{ w = 1, k = 1 }}\n[states]\nc = 0\n"
            "theta = {{ initial = 0, period = \"2*pi\" }}\n"
            "[events]\na = {{ function = \"sin(theta)\", kind = \"section\" }}\n"
            "b = {{ function = \"k*sin(theta)\", kind = \"section\" }}\n"
            "[modes]\none = {{ rates = {{ c = \"w\", theta = \"w\" }}, watch = [\"a\"] }}\n"
            "two = {{ rates = {{ c = 0, theta = \"w\" }}, watch = [\"b\"] }}\n[initial]\nmode = \"one\"\n{}{}",
            transition("one", "a", "two"), transition("two", "b", "one")));
        model.set_parameter("w", rate);
        model.set_parameter("k", random.log_uniform(1e-9, 1e9));
        Experiment experiment(model, with_tolerance(random.log_uniform(1e-15, 1e-6)));
        const Outcome outcome = experiment.run_from({0, theta}, 0, 62.9 / rate);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        const double pi = 3.14159265358979323846;
        const auto falls =
            static_cast<std::size_t>(std::floor((theta + 62.9 + pi) / (2 * pi)) - std::floor((theta + pi) / (2 * pi)));
        EXPECT_EQ(experiment.recorder.contacts().size(), falls) << rate << " " << theta;
    }
}

/// A ball on a floor counts its contacts by a section that coincides with the floor, watched before or after it.
Model counting_ball(double e, double drag, const std::string& section, bool first) {
    return model_from(
        fmt::format("name = \"count\"\n[states]\nx = 1\nv = 0\nn = 0\n"
                    "[parameters]\ne = {:.17g}\ndrag = {:.17g}\n[events]\nfloor = \"x\"\n"
                    "below = {{ function = \"{}\", kind = \"section\" }}\n"
                    "[modes]\nflight = {{ rates = {{ x = \"v\", v = \"-1 - drag*v\", n = 0 }}, watch = [{}] }}\n"
                    "rest = {{ rates = {{ x = 0, v = 0, n = 0 }} }}\n[initial]\nmode = \"flight\"\n"
                    "[jumps]\nhit = {{ v = \"-e*v\" }}\ncount = {{ n = \"n + 1\" }}\nland = {{ x = 0, v = 0 }}\n"
                    "{}chatter = {{ jump = \"land\", mode = \"rest\" }}\n{}",
                    e, drag, section, first ? "\"below\", \"floor\"" : "\"floor\", \"below\"",
                    transition("flight", "floor", "flight", "hit"), transition("flight", "below", "flight", "count")));
}

TEST(SharedSurface, ASectionThatCoincidesWithABarrierIsHandledToo) {
    Random random(54);
    for (int i = 0; i < 3000; ++i) {
        const bool first = random.chance(0.5), starts_at_rest = random.chance(0.5);
        const double e = random.uniform(0.3, 0.9), height = random.log_uniform(1e-9, 1e6);
        const double factor = random.chance(0.3) ? 3 : random.log_uniform(1e-9, 1e9);
        Experiment experiment(counting_ball(e, 0, fmt::format("{:.17g}*x", factor), first),
                              with_tolerance(random.log_uniform(1e-15, 1e-6)));
        const double fall = std::sqrt(2 * height), rest = fall * (1 + e) / (1 - e);
        const double early = starts_at_rest ? 0 : random.uniform(0.05, 0.3) * fall; // with the speed of that time
        const double end = random.uniform(0.5, 0.9) * rest;
        const Outcome outcome = experiment.run_from({height - early * early / 2, -early, 0}, 0, end - early);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        double hits = 0;
        for (double time = fall, flight = 2 * e * fall; time < end; time += flight, flight *= e)
            ++hits;
        // After the floor's jump the section no longer falls: that is the documented order.
        EXPECT_EQ(experiment.state()[2], first ? hits : 0)
            << fmt::format("{} {} {} {} {} {}", e, height, factor, early, first, end);
    }
}

TEST(SharedSurface, CurvedSectionsThatCoincideWithABarrierAreHandledToo) {
    Random random(55);
    for (int i = 0; i < 3000; ++i) {
        const double e = random.uniform(0.3, 0.9), height = random.log_uniform(1e-9, 1e6);
        const double factor = random.log_uniform(1e-9, 1e9), curvature = random.log_uniform(0.01, 3) / height;
        const double fall = std::sqrt(2 * height), drag = random.chance(0.2) ? 0 : random.log_uniform(1e-3, 0.5) / fall;
        const char* sections[] = {"{:.17g}*x*(1 + {:.17g}*x)", "{:.17g}*(exp({:.17g}*x) - 1)",
                                  "{:.17g}*x/(1 + {:.17g}*x)"};
        const std::string section = fmt::format(fmt::runtime(sections[i % 3]), factor, curvature);
        Experiment experiment(counting_ball(e, drag, section, true), with_tolerance(random.log_uniform(1e-15, 1e-6)));
        // Only until flights become so low that such functions cannot resolve them.
        const double end = fall * (1 + random.uniform(0.1, 0.6) * 2 * e / (1 - e));
        const Outcome outcome = experiment.run_from({height, 0, 0}, 0, end);
        ASSERT_EQ(outcome.ending, Ending::end_time) << outcome.detail;
        double hits = 0;
        for (const auto& recorded : experiment.recorder.contacts())
            hits += recorded.contact.event == 0 && recorded.contact.kind == ContactKind::crossing;
        EXPECT_EQ(experiment.state()[2], hits) << fmt::format("{} {} {} {}", e, height, drag, section);
    }
}

TEST(SharedSurface, PressedAgainstTwoBarriersItSticksOnce) {
    for (const char* order : {"\"a\", \"b\"", "\"b\", \"a\""}) {
        const Model model = model_from(fmt::format(
            "name = \"stop\"\nstates = {{ x = 1, v = 0 }}\n[events]\na = \"x\"\nb = \"3*x\"\n"
            "[modes]\nflight = {{ rates = {{ x = \"v\", v = -1 }}, watch = [{}] }}\n"
            "rest = {{ rates = {{ x = 0, v = 0 }} }}\n[initial]\nmode = \"flight\"\n[jumps]\nstop = {{ v = 0 }}\n"
            "{}chatter = {{ mode = \"rest\" }}\n{}chatter = {{ mode = \"rest\" }}\n",
            order, transition("flight", "a", "flight", "stop"), transition("flight", "b", "flight", "stop")));
        Experiment experiment(model);
        EXPECT_EQ(experiment.run(5).ending, Ending::end_time);
        EXPECT_EQ(experiment.trajectory.mode(), 1U);
        EXPECT_LE(experiment.recorder.contacts().size(), 3U);
    }
}

/// A converter with peak-current control: the current i rises in `on` until it reaches its peak, and falls in `off`
/// until the clock c ticks. Optionally, separate modes follow the first tick.
Model converter(double rise, double fall, bool ends_at_second_tick) {
    const std::string then = ends_at_second_tick ? "later_" : "";
    std::string text =
        fmt::format("name = \"converter\"\nstates = {{ i = 0, c = 0 }}\n[events]\npeak = \"1 - i\"\ntick = \"1 - c\"\n"
                    "[jumps]\nreset = {{ c = 0 }}\n[initial]\nmode = \"on\"\n[modes]\n");
    for (const char* prefix : {"", "later_"})
        text += fmt::format("{0}on = {{ rates = {{ i = {1:.17g}, c = 1 }}, watch = [\"peak\", \"tick\"] }}\n"
                            "{0}off = {{ rates = {{ i = {2:.17g}, c = 1 }}, watch = [\"tick\"] }}\n",
                            prefix, rise, -fall);
    return model_from(text + transition("on", "peak", "off") + transition("on", "tick", "on", "reset") +
                      transition("off", "tick", then + "on", "reset") + transition("later_on", "peak", "later_off") +
                      transition("later_on", "tick", "later_on", "reset") +
                      transition("later_off", "tick", "end", "reset"));
}

const std::vector<std::pair<double, double>> peaks_at_ticks{{0.5, 0.5}, {0.25, 0.75}, {0.125, 0.875},  {0.3, 0.7},
                                                            {0.1, 0.9}, {0.7, 0.3},   {0.0625, 0.9375}};

TEST(SharedSurface, AnEventThatWasResetIsDueOnlyAtTheNextZero) {
    // The peak and the tick coincide at time 1. The tick is handled once, the peak in both modes; the clock then runs
    // for its whole period.
    for (const auto& [rise, start] : peaks_at_ticks) {
        Experiment experiment(converter(rise, 1.3, true));
        const Outcome outcome = experiment.run_from({start, 0}, 0, 3.5);
        EXPECT_EQ(outcome.ending, Ending::terminal) << rise << " " << outcome.detail;
        EXPECT_NEAR(outcome.time, 2, 1e-14) << rise;
        ASSERT_EQ(experiment.recorder.contacts().size(), 4U) << rise;
        for (const auto& recorded : experiment.recorder.contacts())
            EXPECT_NEAR(recorded.contact.value, 0, 1e-13) << rise;
    }
}

TEST(SharedSurface, AConverterWhosePeakCoincidesWithATickContinues) {
    // In each period the current rises from i to the peak in (1 - i) / rise, then falls for the rest.
    for (const auto& [rise, start] : peaks_at_ticks) {
        const double fall = 0.6 * rise;
        Experiment experiment(converter(rise, fall, false));
        constexpr int periods = 12;
        const Outcome outcome = experiment.run_from({start, 0}, 0, periods);
        ASSERT_EQ(outcome.ending, Ending::end_time) << rise << " " << outcome.detail;
        double current = 1;
        for (int k = 1; k < periods; ++k)
            current = 1 - fall * (1 - (1 - current) / rise);
        EXPECT_NEAR(experiment.state()[0], current, 1e-12) << rise;
    }
}

TEST(SharedSurface, AnEventMovedOffItsSurfaceByAJumpIsNotDueAfterAThirdEvent) {
    // Three clocks strike together. The jump of the first resets itself and the second; the third then switches to a
    // mode that watches only the second.
    const Model model = model_from(
        "name = \"clocks\"\nstates = { a = 0, b = 0, c = 0 }\n[events]\nfirst = \"1 - a\"\nsecond = \"1 - b\"\n"
        "third = \"1 - c\"\n[jumps]\nback = { a = 0, b = 0.25 }\n[modes]\n"
        "one = { rates = { a = 1, b = 1, c = 1 }, watch = [\"first\", \"second\", \"third\"] }\n"
        "two = { rates = { a = 1, b = 1, c = 1 }, watch = [\"third\", \"second\"] }\n"
        "three = { rates = { a = 1, b = 1, c = 1 }, watch = [\"second\"] }\n[initial]\nmode = \"one\"\n" +
        transition("one", "first", "two", "back") + transition("one", "second", "end") +
        transition("one", "third", "end") + transition("two", "third", "three") + transition("two", "second", "end") +
        transition("three", "second", "end"));
    Experiment experiment(model);
    const Outcome outcome = experiment.run(3);
    EXPECT_EQ(outcome.ending, Ending::terminal);
    EXPECT_NEAR(outcome.time, 1.75, 1e-14);
    EXPECT_EQ(experiment.recorder.contacts().size(), 3U);
}

} // namespace shared_surface_test

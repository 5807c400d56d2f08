#include "page/trip_json.hpp"

#include "graze/grazing/trial.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/results/touching_orbit.hpp"
#include "graze/results/trip_table.hpp"
#include "graze/study/study_catalogue.hpp"
#include "page/figure_json.hpp"
#include "page/grazing_json.hpp"
#include "page/table_json.hpp"
#include "study/study_fixture.hpp"

#include <gtest/gtest.h>

namespace graze {
namespace {

/// The branch of the switch up to its touch, beyond which it trips.
class TripJson : public ::testing::Test {
protected:
    static const ResultFile& file() {
        static testing::StudyResults results(load_study("mems-switch"));
        static const bool done = !results.run({"no_impact"}).empty();
        return done ? results.file() : results.file();
    }
    static OrbitRecord touch() { return *file().orbit("no_impact", std::string("GR1")); }
};

TEST_F(TripJson, VerdictIsThatOfTheMap) {
    const nlohmann::json json = grazing_json(file(), "no_impact", touch().number);
    const TouchingOrbit orbit = find_touching_orbit(file(), "no_impact:GR1", "", {}, {});
    const TouchReport report = touch_report(System(orbit.stored.run.model), orbit.map, orbit.parameter, false);
    EXPECT_EQ(json["verdict"], name_of(report.verdict.outcome));
    EXPECT_EQ(json["verdict"], "lost");
    EXPECT_EQ(json["words"], "no attractor remains near the grazing orbit");
    bool found = false;
    for (const nlohmann::json& fact : json["facts"])
        if (fact[0] == "growth") {
            found = true;
            EXPECT_EQ(fact[1], *report.verdict.growth);
        }
    EXPECT_TRUE(found);
}

TEST_F(TripJson, TimesAreThoseOfTheLibrary) {
    TripWish wish;
    wish.overshoots = {"1e-4", "1e-3"};
    const nlohmann::json json = trip_json(file(), "no_impact", touch().number, wish);
    const StoredOrbit stored = find_stored_orbit(file(), "no_impact:GR1", {});
    const LossPoint point = loss_point(stored, "", {}, {});
    TripOptions options;
    options.cycles = 2000;
    const OvershootTrips trips = overshoot_trips(point, usual_end(point), {1e-4, 1e-3}, options);
    EXPECT_TRUE(json["complete"].get<bool>());
    EXPECT_EQ(json["table"], table_json("trips", trip_table(trips)));
    EXPECT_EQ(json["table"]["rows"].size(), 2U);
    EXPECT_EQ(json["figure"], figure_json(trip_figure({trips})));
    EXPECT_EQ(json["parameter"], point.name);
    EXPECT_EQ(json["value"], point.value);
    EXPECT_NE(json["words"].get<std::string>().find("touch at " + point.name), std::string::npos);
}

TEST_F(TripJson, EndsWhenItIsInterrupted) {
    TripWish wish;
    wish.interrupted = [] { return true; };
    const nlohmann::json json = trip_json(file(), "no_impact", touch().number, wish);
    EXPECT_FALSE(json["complete"].get<bool>());
    EXPECT_FALSE(json["notes"].empty());
    EXPECT_LE(json["table"]["rows"].size(), 1U);
}

TEST_F(TripJson, IsRefusedWhereNothingIsLost) {
    EXPECT_THROW(trip_json(file(), "no_impact", 0, {}), InputError);
    EXPECT_THROW(trip_json(file(), "nothing", 0, {}), InputError);
    EXPECT_THROW(grazing_json(file(), "no_impact", 0), InputError);
    EXPECT_THROW(grazing_json(file(), "no_impact", 1'000'000), InputError);
    const std::size_t number = touch().number;
    EXPECT_THROW(trip_json(file(), "no_impact", number, {.overshoots = {"<b>"}}), InputError);
    EXPECT_THROW(trip_json(file(), "no_impact", number, {.overshoots = {"0"}}), InputError);
    EXPECT_THROW(trip_json(file(), "no_impact", number, {.until = "nothing"}), InputError);
    EXPECT_THROW(trip_json(file(), "no_impact", number, {.cycles = 1e9}), InputError);
    EXPECT_THROW(trip_json(file(), "no_impact", number, {.parameter = "unknown"}), InputError);
}

} // namespace
} // namespace graze

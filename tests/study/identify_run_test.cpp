// What studies find from records, against closed forms and the library's functions: estimates with their errors, fits,
// parameters that other runs take, and what is refused.

#include "graze/identify/coupling.hpp"
#include "graze/identify/fit.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/stored_study.hpp"

#include "study_fixture.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace graze::identify_run_test {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double w0 = 95.94, zeta = 0.016, mass = 0.6462, gap = 4.8e-3, beta1 = 1.9e-5, beta2 = 1.6e-3;

class IdentifyRunTest : public testing::StudyFixture {
protected:
    /// The velocity of an oscillator that is let go.
    /// @param time, speed units in the file of a millisecond and of 1 m/s
    void write_release(const std::string& name, const std::string& head = "t [s], v [m/s]", double time = 1e-3,
                       double speed = 1) const {
        std::string text = head + '\n';
        const double wd = w0 * std::sqrt(1 - zeta * zeta);
        for (int i = 0; i < 1500; ++i)
            text += fmt::format("{:.17g},{:.17g}\n", time * i,
                                speed * 0.07 * std::exp(-zeta * w0 * i * 1e-3) * std::sin(wd * i * 1e-3));
        folder_.write(name, text);
    }
    /// Equilibria, with displacements that are off by an alternating part of themselves.
    std::vector<StaticLoad> write_loads(const std::string& name) const {
        std::vector<StaticLoad> loads;
        std::string text = "n, q [m], I [A]\n";
        for (int i = 1; i <= 12; ++i) {
            const double q = 1e-4 * i;
            const double current = (gap + beta2 - q) * std::sqrt(2 * mass * w0 * w0 * q / beta1);
            loads.push_back({q * (1 + (i % 2 == 0 ? 1e-3 : -1e-3)), current});
            text += fmt::format("{},{:.17g},{:.17g}\n", i, loads.back().displacement, current);
        }
        folder_.write(name, text);
        return loads;
    }
    EstimateRecord estimate(const std::string& of, const std::string& name) const {
        const ResultFile file(path_, ResultFile::Access::read);
        for (const EstimateRecord& number : file.estimates(of).numbers)
            if (number.name == name)
                return number;
        ADD_FAILURE() << "no " << name;
        return {};
    }
};

const char* const head = R"(name = "s"
model = "electromagnetic-testbed"
[runs.releases]
kind = "record"
files = "r*.csv"
[runs.decay]
kind = "identify"
what = "decrement"
records = "releases"
gives = { natural_frequency = "w0", damping_ratio = "zeta" }
)";

const char* const loads_text = R"([runs.loads]
kind = "record"
files = "loads.csv"
channels = ["q", "I"]
[runs.coupling]
kind = "identify"
what = "coupling"
records = "loads"
parameters = "decay"
gap = 4.8e-3
stiffness = "m*w0^2"
)";

TEST_F(IdentifyRunTest, DecrementAndCouplingFindWhatTheRecordsWereMadeWith) {
    for (const char* name : {"r1.csv", "r2.csv", "r3.csv"})
        write_release(name);
    const auto loads = write_loads("loads.csv");
    testing::expect_complete(run(std::string(head) + loads_text));
    // Peaks by polynomials through some of 65 samples a period: six digits.
    EXPECT_NEAR(estimate("decay", "w0").estimate.value, w0, 1e-5 * w0);
    EXPECT_NEAR(estimate("decay", "zeta").estimate.value, zeta, 1e-3 * zeta);
    EXPECT_EQ(estimate("decay", "w0").unit, "rad/s");
    // The library with the stiffness of the frequency that was found, and 2 m w0 times its error.
    const Estimate found = estimate("decay", "w0").estimate;
    CouplingSettings settings;
    settings.gap = gap;
    settings.stiffness = mass * found.value * found.value;
    settings.stiffness_error = 2 * mass * found.value * found.error;
    const Coupling expected = coupling(loads, settings);
    for (const auto& [name, value] : {std::pair{"beta1", expected.beta1}, std::pair{"beta2", expected.beta2}}) {
        const Estimate one = estimate("coupling", name).estimate;
        EXPECT_NEAR(one.value, value.value, 1e-9 * value.value) << name;
        EXPECT_NEAR(one.error, value.error, 1e-6 * value.error) << name;
    }
    EXPECT_NEAR(estimate("coupling", "beta1").estimate.value, beta1, 0.02 * beta1); // displacements are off by 1e-3
    const ResultFile file(path_, ResultFile::Access::read);
    const EstimateRecords both = file.estimates("coupling");
    const std::size_t count = both.numbers.size();
    ASSERT_EQ(both.covariance.size(), count * count);
    EXPECT_NEAR(both.covariance[1],
                expected.correlation * both.numbers[0].estimate.error * both.numbers[1].estimate.error,
                1e-6 * std::abs(both.covariance[1]));
}

// The same release and loads as above, written in other units: the same parameters of the model come out.
TEST_F(IdentifyRunTest, EstimatesHaveTheUnitsOfTheModel) {
    write_release("r1.csv", "t [ms], v [um/s]", 1, 1e6);
    std::string loads = "n, q [m], I [mA]\n", held = "t [us], V [uV], I [MA]\n";
    for (int i = 1; i <= 12; ++i) {
        const double q = 1e-4 * i * (1 + (i % 2 == 0 ? 1e-3 : -1e-3));
        loads += fmt::format("{},{:.17g},{:.17g}\n", i, q,
                             1e3 * (gap + beta2 - q) * std::sqrt(2 * mass * w0 * w0 * q / beta1));
    }
    const double reactance = 2 * M_PI * 4 * 0.01; // 1.66 V at 4 Hz over 1.4 ohm and 10 mH
    for (int i = 0; i < 2000; ++i) {
        const double angle = 2 * M_PI * 4 * i * 1e-3;
        const double amperes = 1.66 * std::sin(angle - std::atan2(reactance, 1.4)) / std::hypot(reactance, 1.4);
        held += fmt::format("{},{:.17g},{:.17g}\n", 1000 * i, 1.66e6 * std::sin(angle), 1e-6 * amperes);
    }
    folder_.write("loads.csv", loads);
    folder_.write("held.csv", held);
    const std::string more = R"([runs.held]
kind = "record"
files = "held.csv"
channels = ["V", "I"]
[runs.coil]
kind = "identify"
what = "impedance"
records = "held"
gives = { resistance = "R", inductance = "Ll", frequency = "f" }
)";
    testing::expect_complete(run(std::string(head) + loads_text + more));
    EXPECT_NEAR(estimate("decay", "w0").estimate.value, w0, 1e-5 * w0);
    EXPECT_EQ(estimate("decay", "w0").unit, "rad/s");
    EXPECT_NEAR(estimate("coupling", "beta1").estimate.value, beta1, 0.02 * beta1); // displacements are off by 1e-3
    EXPECT_EQ(estimate("coupling", "beta1").unit, "H m");
    EXPECT_NEAR(estimate("coil", "R").estimate.value, 1.4, 1e-9); // the records are exact
    EXPECT_EQ(estimate("coil", "R").unit, "ohm");
    EXPECT_NEAR(estimate("coil", "Ll").estimate.value, 0.01, 1e-9);
    EXPECT_EQ(estimate("coil", "Ll").unit, "H");
    EXPECT_NEAR(estimate("coil", "f").estimate.value, 4, 1e-9);
    const ResultFile file(path_, ResultFile::Access::read);
    const EstimateRecords decay = file.estimates("decay");
    for (std::size_t i = 0; i < decay.numbers.size(); ++i)
        if (decay.numbers[i].name == "w0") {
            EXPECT_NEAR(decay.covariance[i * (decay.numbers.size() + 1)], std::pow(decay.numbers[i].estimate.error, 2),
                        1e-12 * decay.covariance[i * (decay.numbers.size() + 1)]);
        }
}

// Minutes and words for units are known; an unknown unit beside a known one is refused.
TEST_F(IdentifyRunTest, UsualUnitsOfTimeAreKnownAndOthersRefused) {
    const auto write = [&](const char* unit, double by) {
        write_release("r1.csv", fmt::format("t [{}], v [m/s]", unit), by);
    };
    for (const auto& [unit, by] : {std::pair{"min", 1e-3 / 60}, std::pair{"h", 1e-3 / 3600}, std::pair{"msec", 1.0}}) {
        write(unit, by);
        EXPECT_EQ(refusal(head), "") << unit;
        EXPECT_NEAR(estimate("decay", "w0").estimate.value, w0, 1e-5 * w0) << unit;
        EXPECT_EQ(estimate("decay", "w0").unit, "rad/s");
    }
    write("ticks", 1);
    EXPECT_THAT(refusal(head), HasSubstr("what is found for 'w0' is in 'rad/ticks', a unit that is not known, and the "
                                         "parameter in rad/s"));
}

// Two runs that keep records in other units.
TEST_F(IdentifyRunTest, RecordsOfSeveralRunsArePutTogetherInOneUnit) {
    write_release("r1.csv");
    write_release("other.csv", "t [ms], v [mm/s]", 1, 1000);
    std::string both = head;
    const std::string one = "records = \"releases\"";
    ASSERT_NE(both.find(one), std::string::npos);
    both.replace(both.find(one), one.size(), "records = [\"releases\", \"others\"]");
    both += "[runs.others]\nkind = \"record\"\nfiles = \"other.csv\"\n";
    EXPECT_EQ(refusal(both), "");
    EXPECT_NEAR(estimate("decay", "w0").estimate.value, w0, 1e-5 * w0);
}

TEST_F(IdentifyRunTest, UnitsThatDoNotAgreeAreRefused) {
    write_release("r1.csv");
    folder_.write("loads.csv", "n, q [mm], I [A]\n1, 0.1, 1\n2, 0.2, 1.4\n3, 0.3, 1.7\n4, 0.4, 2\n");
    EXPECT_THAT(refusal(std::string(head) + loads_text),
                HasSubstr("channel 'q' is in mm, and what the model has of that kind in m; convert it in the run that "
                          "has the record: scale = { q = { factor = 0.001, unit = \"m\" } }"));
    std::string other = head;
    other.replace(other.find("\"w0\""), 4, "\"m\"");
    EXPECT_THAT(refusal(other), HasSubstr("what is found for 'm' is in rad/s, and the parameter in kg"));
}

// A ratio has no unit, and no frequency is one; a length is given by a parameter that is one.
TEST_F(IdentifyRunTest, ParametersOfAnotherKindAreRefused) {
    write_release("r1.csv");
    std::string swapped = head;
    swapped.replace(swapped.find("natural_frequency = \"w0\", damping_ratio = \"zeta\""), 48, "damping_ratio = \"w0\"");
    EXPECT_THAT(refusal(swapped), HasSubstr("what is found for 'w0' is without a unit, and the parameter in rad/s"));
    swapped.replace(swapped.find("damping_ratio = \"w0\""), 20, "natural_frequency = \"zeta\"");
    EXPECT_THAT(refusal(swapped), HasSubstr("what is found for 'zeta' is in rad/s, and the parameter without a unit"));
    write_loads("loads.csv");
    const auto with_gap = [&](const std::string& gap_text) {
        std::string text = std::string(head) + loads_text;
        text.replace(text.find("gap = 4.8e-3"), 12, "gap = \"" + gap_text + "\"");
        return refusal(text);
    };
    EXPECT_THAT(with_gap("w0"), HasSubstr("gap = \"w0\" is in rad/s, and m is wanted; name another parameter"));
    EXPECT_THAT(with_gap("zeta"), HasSubstr("gap = \"zeta\" is a number without a unit, and m is wanted"));
    EXPECT_EQ(with_gap("d"), "");
}

TEST_F(IdentifyRunTest, OtherRunsUseTheEstimates) {
    write_release("r1.csv");
    const std::string later = R"([runs.motion]
kind = "simulate"
parameters = "decay"
set = { w0 = 50, V0 = 1 }
time = 1
[runs.orbit]
kind = "orbit"
parameters = "decay"
set = { V0 = 1 }
[runs.on]
kind = "simulate"
start = { run = "motion" }
time = 1
)";
    const std::string text = std::string(head) + later;
    run(text);
    const double found = estimate("decay", "w0").estimate.value;
    {
        ResultFile file(path_, ResultFile::Access::write);
        const auto parameter = [&](const char* name, const char* what) {
            const Model model = stored_model(*file.find_run(name));
            return model.parameter_values()[model.independent_parameter(what).place()];
        };
        EXPECT_EQ(parameter("motion", "w0"), found);
        EXPECT_EQ(parameter("motion", "V0"), 1);
        EXPECT_EQ(parameter("orbit", "w0"), found);
        EXPECT_EQ(parameter("on", "w0"), found); // parameters come with the point
        // The file alone knows that nothing is to be done.
        for (const RunReport& report : run_study(stored_study(file), file, {}))
            EXPECT_EQ(report.computed, 0) << report.name << ' ' << report.problem;
    }
    for (const RunReport& report : run(text))
        EXPECT_EQ(report.computed, 0) << report.name;
    // With other records what follows from them is done anew.
    write_release("r2.csv");
    for (const RunReport& report : run(text))
        EXPECT_GT(report.computed, 0) << report.name;
}

TEST_F(IdentifyRunTest, AFitIsThatOfTheLibrary) {
    // A swing whose square of frequency is sought; readings are its motion with an alternating error.
    folder_.write("swing.toml", "name = \"swing\"\n[parameters]\nk = 4\n[states]\nx = { initial = 1 }\n"
                                "v = { initial = 0 }\n[modes.swing]\nrates = { x = \"v\", v = \"-k*x\" }\n");
    FitTask task;
    FitRecord record;
    record.readings.resize(1);
    std::string text = "t,x\n";
    for (int i = 0; i < 100; ++i) {
        record.times.push_back(0.1 * i);
        record.readings[0].values.push_back(std::cos(2.1 * 0.1 * i) + (i % 2 == 0 ? 1e-3 : -1e-3));
        text += fmt::format("{:.17g},{:.17g}\n", record.times.back(), record.readings[0].values.back());
    }
    folder_.write("swing.csv", text);
    const auto fitted = [&](const std::string& files, const std::string& unknowns) {
        return run("name = \"s\"\nmodel = \"./swing.toml\"\n[runs.record]\nkind = \"record\"\nfiles = " + files +
                   "\n[runs.fit]\nkind = \"identify\"\nwhat = \"fit\"\nrecords = \"record\"\nreadings = [\"x\"]\n"
                   "known = [\"v\"]\nunknowns = " +
                   unknowns + "\n");
    };
    const auto reports = fitted("\"swing.csv\"", "{ k = { guess = 4.2, bounds = [1, 9] } }");
    const Model model = load_model(folder_ / "swing.toml");
    task.parameters.push_back({model.independent_parameter("k"), 4.2, 1, 9});
    MeasuredOutput output;
    output.name = "x";
    output.value = model.symbol("x");
    task.outputs.push_back(output);
    record.unknown_states = {0};
    task.records.push_back(record);
    const Fit fit = fit_model(System(model), task);
    const EstimateRecord k = estimate("fit", "k");
    EXPECT_EQ(k.estimate.value, fit.numbers[0].estimate.value); // the same computation
    EXPECT_EQ(k.estimate.error, fit.numbers[0].estimate.error);
    EXPECT_NEAR(k.estimate.value, 2.1 * 2.1, 1e-3); // what is alternating tells a cosine nothing
    EXPECT_NEAR(estimate("fit", "x(0)").estimate.value, 1, 1e-3);
    fitted("[\"swing.csv\", \"swing.csv\"]", "{ k = 4.2 }");
    EXPECT_NEAR(estimate("fit", "x(0) of record 2").estimate.value, 1, 1e-3);
    // Alternating residuals are no noise, and the fit says so: it must not be gone on with.
    EXPECT_EQ(fit.ending == FitEnding::converged, reports.back().complete()) << reports.back().problem;
}

TEST_F(IdentifyRunTest, EstimatesThatMustNotBeUsedAreStored) {
    write_release("r1.csv");
    // The current leads the voltage, as that of no coil does.
    std::string text = "t [s], V [V], I [A]\n";
    for (int i = 0; i < 1000; ++i)
        text += fmt::format("{},{:.17g},{:.17g}\n", i * 1e-3, 2 * std::sin(25.1e-3 * i), std::sin(25.1e-3 * i + 0.5));
    folder_.write("coil.csv", text);
    const auto reports = run(std::string(head) + "[runs.clamped]\nkind = \"record\"\nfiles = \"coil.csv\"\n"
                                                 "[runs.coil]\nkind = \"identify\"\nwhat = \"impedance\"\n"
                                                 "records = \"clamped\"\nparameters = \"decay\"\n"
                                                 "gives = { resistance = \"R\" }\n"
                                                 "[runs.on]\nkind = \"simulate\"\nparameters = \"coil\"\ntime = 1\n");
    EXPECT_EQ(reports[3].outcome, RunOutcome::failed);
    EXPECT_THAT(reports[3].problem, HasSubstr("inductance comes out below zero"));
    EXPECT_EQ(reports[4].outcome, RunOutcome::skipped);
    // V0/I0 cos(phi) of amplitudes 2 and 1, half a radian apart
    EXPECT_NEAR(estimate("coil", "R").estimate.value, 2 * std::cos(0.5), 1e-6);
    const ResultFile file(path_, ResultFile::Access::read);
    EXPECT_EQ(file.point_count("coil"), 1);
}

TEST_F(IdentifyRunTest, FailsWithAllRunsThatNeedItWhereNothingIsFound) {
    folder_.write("r1.csv", "t [s], v [m/s]\n0,1\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,1\n8,1\n9,1\n10,1\n11,1\n");
    const auto reports =
        run(std::string(head) + "[runs.motion]\nkind = \"simulate\"\nparameters = \"decay\"\ntime = 1\n");
    ASSERT_EQ(reports.size(), 3);
    EXPECT_EQ(reports[1].outcome, RunOutcome::failed);
    EXPECT_THAT(reports[1].problem, HasSubstr("r1.csv"));
    EXPECT_EQ(reports[2].outcome, RunOutcome::skipped);
    EXPECT_THAT(reports[2].problem, HasSubstr("'decay', which it needs, failed"));
}

TEST_F(IdentifyRunTest, AParameterIsFoundOnceOrRefined) {
    write_release("r1.csv");
    const auto study = [&](const std::string& second, const std::string& taken) {
        return std::string(head) + "[runs.again]\nkind = \"identify\"\nwhat = \"decrement\"\nrecords = \"releases\"\n" +
               "gives = { damping_ratio = \"zeta\" }\n" + second + "[runs.motion]\nkind = \"simulate\"\ntime = 0.1\n" +
               "parameters = " + taken + "\n";
    };
    EXPECT_THAT(refusal(study("", R"(["decay", "again"])")),
                HasSubstr("s.toml:19:1: runs 'decay' and 'again' both find 'zeta'; name one of them"));
    EXPECT_THAT(refusal(study("", R"(["decay", "decay"])")), HasSubstr("s.toml:19:1: run 'decay' is named twice"));
    EXPECT_THAT(refusal(study("parameters = \"decay\"\n", R"(["again", "decay"])")), HasSubstr("both find 'zeta'"));
    EXPECT_EQ(refusal(study("parameters = \"decay\"\n", R"(["decay", "again"])")), "");
}

TEST_F(IdentifyRunTest, RefusesInvalidStudies) {
    write_release("r1.csv");
    const std::string records = "name = \"s\"\nmodel = \"electromagnetic-testbed\"\n[runs.a]\nkind = \"record\"\n"
                                "files = \"r1.csv\"\n[runs.b]\nkind = \"identify\"\n";
    const std::string decrement = records + "what = \"decrement\"\n";
    EXPECT_EQ(refusal(decrement + "records = \"a\"\n"), "");
    EXPECT_THAT(refusal(records), HasSubstr("does not say what is to be found"));
    EXPECT_THAT(refusal(decrement), HasSubstr("has no records"));
    EXPECT_THAT(refusal(decrement + "records = \"c\"\n"), HasSubstr("the study has no run 'c'"));
    EXPECT_THAT(refusal(decrement + "records = \"b\"\n"), HasSubstr("starts from itself"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\n[runs.c]\nkind = \"identify\"\nwhat = \"decrement\"\n"
                                    "records = \"b\"\n"),
                HasSubstr("run 'b' is of kind \"identify\""));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\nparameters = \"a\"\n"), HasSubstr("of kind \"record\""));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\nparameters = \"b\"\n"), HasSubstr("starts from itself"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\nchannel = \"I\"\n"), HasSubstr("I"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\ngap = 3\n"), HasSubstr("`gap` has no effect on a decrement"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\ngives = { damping_ratio = \"zzeta\" }\n"),
                HasSubstr("has no parameter 'zzeta'; did you mean 'zeta'?"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\ngives = { damping = \"zeta\" }\n"),
                HasSubstr("s.toml:10:11: nothing of the name 'damping' is found; it finds natural_frequency"));
    EXPECT_THAT(
        refusal(decrement + "records = \"a\"\ngives = { damping_ratio = \"zeta\", natural_frequency = \"zeta\" }\n"),
        AllOf(HasSubstr("s.toml:10:55:"), HasSubstr("cannot both be 'zeta'")));
    EXPECT_THAT(refusal(decrement + "records = 3\n"),
                HasSubstr("s.toml:9:11: runs.b.records must be a name or a list"));
    EXPECT_THAT(refusal(records + "what = \"coupling\"\nrecords = \"a\"\n"), HasSubstr("gap or stiffness"));
    EXPECT_THAT(refusal(records + "what = \"fit\"\nrecords = \"a\"\n"), HasSubstr("what is to be found"));
    EXPECT_THAT(refusal(records + "what = \"fit\"\nrecords = \"a\"\nunknowns = [\"w1\"]\nreadings = [\"v\"]\n"),
                HasSubstr("has no parameter 'w1'"));
    EXPECT_THAT(refusal(decrement + "records = \"a\"\n[runs.c]\nkind = \"simulate\"\ntime = 1\nparameters = \"b\"\n"),
                HasSubstr("run 'b' has found no parameter of model"));
}

} // namespace graze::identify_run_test

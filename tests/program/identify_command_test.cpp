#include "run_graze.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

namespace graze::testing::identify_command_test {

using ::testing::HasSubstr;

constexpr double natural = 95.94, damping = 0.01626, beta1 = 1.902e-5, beta2 = 1.631e-3, gap = 4.79e-3;
constexpr double stiffness = 5948, resistance = 1.39, leakage = 10.55e-3;

/// Records without noise, from which parameters are found to nine digits.
class IdentifyCommand : public ::testing::Test {
protected:
    std::string release(const std::string& name, double displacement) const {
        const double damped = natural * std::sqrt(1 - damping * damping);
        std::string text = "t [s], v [m/s]\n";
        for (int i = 0; i < 1500; ++i) {
            const double t = i * 1e-3;
            text += fmt::format("{},{}\n", t, -displacement * std::exp(-damping * natural * t) * std::sin(damped * t));
        }
        return folder.write(name, text);
    }
    std::string equilibria() const {
        std::string text = "n, q [m], I [A]\n";
        for (int i = 1; i <= 20; ++i) {
            const double q = i * 6e-5;
            text += fmt::format("{},{},{}\n", i, q, (gap + beta2 - q) * std::sqrt(2 * stiffness * q / beta1));
        }
        return folder.write("static.csv", text);
    }
    std::string clamped(double omega) const {
        const double inductance = leakage + beta1 / (beta2 + gap - 1e-3),
                     lag = std::atan2(omega * inductance, resistance);
        std::string text = "t [s], V [V], I [A]\n";
        for (int i = 0; i < 2000; ++i) {
            const double t = i * 1e-3;
            text += fmt::format("{},{},{}\n", t, std::sin(omega * t),
                                std::sin(omega * t - lag) / std::hypot(resistance, omega * inductance));
        }
        return folder.write(fmt::format("clamped{}.csv", omega), text);
    }
    const Folder folder;
};

Csv identified(const std::string& line) {
    return Csv(done("identify " + line + " --format csv"));
}

TEST_F(IdentifyCommand, FindsFrequencyAndDamping) {
    const Csv table = identified("decrement " + release("a.csv", 1) + " " + release("b.csv", 0.5));
    EXPECT_EQ(table.text(0, "name"), "natural_frequency");
    EXPECT_EQ(table.text(0, "unit"), "rad/s");
    EXPECT_NEAR(table.number(0, "value"), natural, 1e-9 * natural);
    EXPECT_NEAR(table.number(1, "value"), damping, 1e-9);
    EXPECT_LE(table.number(0, "low"), table.number(0, "value"));
    EXPECT_GT(table.number(0, "freedom"), 1000); // all samples are used, not only the peaks
}

TEST_F(IdentifyCommand, FindsTheRestPositionOfARelease) {
    const double damped = natural * std::sqrt(1 - damping * damping);
    std::string text = "t [s], q [mm]\n";
    for (int i = 0; i < 1500; ++i) {
        const double t = i * 1e-3;
        text += fmt::format("{},{}\n", t, 3 - std::exp(-damping * natural * t) * std::sin(damped * t));
    }
    const Csv table = identified("decrement " + folder.write("offset.csv", text) + " --channel q");
    EXPECT_NEAR(table.number(1, "value"), damping, 1e-9);
    EXPECT_EQ(table.text(4, "name"), "rest_position");
    EXPECT_EQ(table.text(4, "unit"), "mm");
    EXPECT_NEAR(table.number(4, "value"), 3, 1e-9);
}

TEST_F(IdentifyCommand, FindsTheFrequencyAndWarnsOfNegativeResistance) {
    const Csv table = identified("impedance " + clamped(20));
    EXPECT_EQ(table.text(2, "name"), "frequency");
    EXPECT_EQ(table.text(2, "unit"), "Hz");
    EXPECT_NEAR(table.number(2, "value"), 20 / (2 * std::acos(-1.0)), 1e-9);
    const Printed turned = run_graze("identify impedance " + clamped(20) + " --scale I=-1");
    EXPECT_EQ(turned.code, 3);
    EXPECT_THAT(turned.err, HasSubstr("warning: "));
    EXPECT_THAT(turned.err, HasSubstr("the resistance comes out below zero"));
}

TEST_F(IdentifyCommand, FindsTheCoupling) {
    const Csv table = identified("coupling " + equilibria() + fmt::format(" --gap {} --stiffness {}", gap, stiffness));
    EXPECT_EQ(table.text(0, "unit"), "H m");
    EXPECT_NEAR(table.number(0, "value"), beta1, 1e-9 * beta1);
    EXPECT_NEAR(table.number(1, "value"), beta2, 1e-9 * beta2);
}

TEST_F(IdentifyCommand, FindsResistanceAndInductance) {
    const Csv table = identified("impedance " + clamped(20) + " " + clamped(50) +
                                 fmt::format(" --gap {} --beta1 {} --beta2 {} --clamped 1e-3", gap, beta1, beta2));
    EXPECT_EQ(table.text(0, "unit"), "ohm");
    EXPECT_NEAR(table.number(0, "value"), resistance, 1e-9 * resistance);
    EXPECT_EQ(table.text(4, "name"), "leakage_inductance");
    EXPECT_NEAR(table.number(4, "value"), leakage, 1e-9 * leakage);
}

TEST_F(IdentifyCommand, FindsTheRestitution) {
    std::string text = "t [s], v [m/s]\n";
    for (int i = 0; i < 6000; ++i) {
        const double t = i * 1e-3 + 0.0005, part = t - std::floor(t); // impacts between two samples
        text += fmt::format("{},{}\n", t, -0.8 + 1.8 * part);
    }
    const Csv table = identified("restitution " + folder.write("run.csv", text));
    EXPECT_NEAR(table.number(0, "value"), 0.8, 1e-9);
    const std::string picture = folder / "e.svg";
    if (std::system("command -v gnuplot > /dev/null") == 0) {
        done("identify restitution " + (folder / "run.csv") + " --plot " + picture);
        EXPECT_THAT(contents(picture), HasSubstr("</svg>"));
    }
}

TEST_F(IdentifyCommand, MistakesAreOneLineWithARemedy) {
    const std::string a = release("a.csv", 1), empty = folder.write("none_there.csv", "t [s], v [m/s]\n");
    const std::vector<std::pair<std::string, std::string>> mistakes{
        {"", "what to find is missing"},
        {"decrement", "write graze identify WHAT FILE"},
        {"decrememt " + a, "did you mean 'decrement'?"},
        {"decrement " + a + " --channel w", "--channel: the record has no channel 'w'"},
        {"decrement " + (folder / "none.csv"), "none.csv: the record cannot be read"},
        {"decrement " + a + " --gap 1", "--gap has no effect beside WHAT decrement"},
        {"coupling " + equilibria(), "give --gap and --stiffness"},
        {"impedance " + clamped(20) + " --beta1 1", "give --beta1, --beta2 and --gap, or none"},
        {"impedance " + clamped(20) + " --beta1 x --beta2 1 --gap 1", "'x' is no number"},
        {"restitution " + a, "too few impacts"},
        {"decrement " + empty, "none_there.csv: the record has no rows"},
        {"decrement " + a + " " + empty, "none_there.csv: the record has no rows"},
        {"decrement " + a + " --from 1e9", "a.csv: the record has no rows"},
        {"restitution " + empty, "none_there.csv: the record has no rows"},
        {"coupling " + empty + " --gap 1 --stiffness 1 --displacement v --current v", "none_there.csv: the record has"},
        {"impedance " + empty + " --voltage v --current v", "none_there.csv: the record has no rows"},
        {"decrement " + a + " --scale v=1e306", "a.csv: the values of 'v' go up to"},
        {"decrement " + a + " --scale v=1e-310", "numbers of that size are not handled"},
        {"decrement " + a + " --peaks 2", "two stand out from the noise, three are needed"},
        {"decrement " + a + " --data d", "--data has no effect without --plot"},
    };
    for (const auto& [line, message] : mistakes)
        expect_refusal("identify " + line, message);
}

/// The command reads the files; the study stores their records in one run and uses them in another.
TEST_F(IdentifyCommand, EqualsTheEstimatesOfAStudyBitForBit) {
    const std::string a = release("a.csv", 1), b = release("b.csv", 0.5), loads = equilibria(), coil = clamped(20);
    std::filesystem::copy(loads, folder / "more.csv");
    folder.write("s.toml", R"(name = "s"
model = "electromagnetic-testbed"
[runs.releases]
kind = "record"
files = ["a.csv", "b.csv"]
[runs.loads]
kind = "record"
files = ["static.csv", "more.csv"]
[runs.held]
kind = "record"
files = "clamped20.csv"
[runs.decrement]
kind = "identify"
what = "decrement"
records = "releases"
[runs.coupling]
kind = "identify"
what = "coupling"
records = "loads"
each_row = true
gap = 4.79e-3
gap_error = 1e-5
stiffness = 5948
stiffness_error = 20
[runs.impedance]
kind = "identify"
what = "impedance"
records = "held"
gap = 4.79e-3
beta1 = 1.902e-5
beta1_error = 2e-7
beta2 = 1.631e-3
beta2_error = 1e-5
clamped = 1e-3
)");
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const Printed printed = run_graze("identify s.toml --format csv");
    std::filesystem::current_path(before);
    ASSERT_EQ(printed.code, 0) << printed.err;
    const Csv study(printed.out);
    std::size_t found = 0;
    for (const std::string& line :
         {"decrement " + a + " " + b,
          "coupling " + loads + " " + (folder / "more.csv") +
              " --gap 4.79e-3 --gap-error 1e-5 --stiffness 5948 --stiffness-error 20",
          "impedance " + coil + " --gap 4.79e-3 --beta1 1.902e-5+-2e-7 --beta2 1.631e-3+-1e-5 --clamped 1e-3"}) {
        const Csv table = identified(line);
        for (std::size_t row = 0; row < table.rows.size(); ++row, ++found) {
            ASSERT_LT(found, study.rows.size());
            for (const char* column : {"name", "value", "error"})
                EXPECT_EQ(table.text(row, column), study.text(found, column)) << line;
        }
    }
    EXPECT_EQ(found, study.rows.size());
}

/// Computes the study's runs of kind identify and the runs they depend on, but not its sweep.
TEST_F(IdentifyCommand, ComputesOnlyTheIdentifyRunsOfAStudy) {
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder / ".");
    const Printed printed = run_graze("identify testbed-experiment --format csv");
    const Printed again = run_graze("identify testbed-experiment --format csv");
    const Printed exported = run_graze("export testbed-experiment --what estimates --format csv");
    const Printed runs = run_graze("export testbed-experiment --what runs --format csv");
    const Printed picture = run_graze("identify testbed-experiment --plot a.png");
    const Printed crowd = run_graze("identify testbed-experiment a.csv");
    const Printed without = run_graze("identify mems-switch");
    std::filesystem::current_path(before);
    EXPECT_EQ(printed.code, 0) << printed.err;
    EXPECT_EQ(again.out, printed.out);
    EXPECT_EQ(exported.out, printed.out);
    const Csv found(printed.out);
    ASSERT_GE(found.rows.size(), 8U);
    EXPECT_EQ(found.text(0, "run"), "decay");
    EXPECT_EQ(found.text(0, "name"), "w0");
    EXPECT_LT(found.number(0, "low"), found.number(0, "value"));
    EXPECT_THAT(runs.out, HasSubstr("releases"));
    EXPECT_THAT(runs.out, ::testing::Not(HasSubstr("predicted")));
    EXPECT_THAT(picture.err, HasSubstr("--plot has no effect"));
    EXPECT_EQ(crowd.code, 2);
    EXPECT_THAT(crowd.err, HasSubstr("name the study alone"));
    EXPECT_EQ(without.code, 2);
    EXPECT_THAT(without.err, HasSubstr("no run of kind identify"));
    EXPECT_THAT(run_graze("identify decremnt a.csv").err, HasSubstr("did you mean 'decrement'?"));
    EXPECT_THAT(run_graze("identify decrement").err, HasSubstr("no records are named"));
}

} // namespace graze::testing::identify_command_test

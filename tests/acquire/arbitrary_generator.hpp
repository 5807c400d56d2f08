#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace graze::testing {

/// A simulated generator for tests, independent of that of the virtual bench. It starts in an arbitrary state and has
/// optional habits of different makers. It records the largest voltages at its output, whatever it is told.
class ArbitraryGenerator {
public:
    enum Habit : unsigned {
        has_switch = 1,            ///< its output has a switch
        keeps_numbers = 2,         ///< 2 dBm becomes 2 V when the unit is changed, and likewise for shapes and loads
        knows_minimum = 4,         ///< understands VOLT MIN
        short_function = 8,        ///< FUNC without SHAP
        unit_is_stuck = 16,        ///< ignores VOLT:UNIT without an error
        load_is_stuck = 32,        ///< likewise
        shape_is_stuck = 64,       ///< likewise
        modulation_is_stuck = 128, ///< likewise
        frequency_resets = 256,    ///< its amplitude is 10 V after each FREQ
        switch_recalls = 512,      ///< its amplitude is 7 V after each OUTP ON
        amplitude_shifts = 1024,   ///< its offset is 1 V after each VOLT
    };

    ArbitraryGenerator(unsigned seed, unsigned habits, double real_load) : habits_(habits), real_load_(real_load) {
        std::mt19937 random(seed);
        const auto draw = [&](double from, double to) { return std::uniform_real_distribution<>(from, to)(random); };
        unit_ = std::vector<std::string>{"VPP", "VRMS", "DBM"}[random() % 3];
        shape_ = std::vector<std::string>{"SIN", "SQU", "RAMP", "NOIS", "DC"}[random() % 5];
        load_ = std::vector<double>{50, 1, 600, 1e4, 9.9e37}[random() % 5];
        number_ = unit_ == "DBM" ? draw(-20, 23) : unit_ == "VRMS" ? draw(0.05, 3.5) : draw(0.05, 10);
        offset_ = draw(-4, 4);
        on_ = (habits & has_switch) == 0 || random() % 2 == 0;
        frequency_ = draw(1, 1e6);
        if (random() % 2 == 0)
            modulation_ = std::vector<std::string>{"AM", "BURS", "SWE", "SUM"}[random() % 4];
        errors_.assign(random() % 3, "-222,\"Data out of range\"");
        first_peaks = peaks();
        first_offset = std::abs(offset());
    }

    /// Executes a line. @return answers, one per line
    std::string execute(const std::string& line) {
        std::string command = line.substr(0, line.find(' ')), argument;
        if (command.size() < line.size())
            argument = line.substr(command.size() + 1);
        const std::string answer = obey(command, argument);
        lines_beyond += peaks() > limit ? 1 : 0;
        greatest_peaks = std::max(greatest_peaks, peaks());
        greatest_offset = std::max(greatest_offset, std::abs(offset()));
        return answer;
    }
    /// A change at its panel, or by switching it off and on.
    void turn_to_rms() { unit_ = "VRMS"; }
    void take(Habit habit) { habits_ |= habit; }

    double peaks() const {
        const double more = modulation_ == "AM" || modulation_ == "SUM" ? 2 : 1;
        return on_ && shape_ != "DC" ? number_ * volts() * inner() * divider() * more : 0;
    }
    double offset() const { return on_ ? offset_ * inner() * divider() : 0; }
    bool is_on() const { return on_; }
    double frequency() const { return frequency_; }

    double first_peaks = 0, first_offset = 0;
    double greatest_peaks = 0, greatest_offset = 0; ///< since the first command, at the real load
    double limit = 1e300;
    std::size_t lines_beyond = 0; ///< number of lines after which it exceeded the limit

private:
    bool has(Habit habit) const { return (habits_ & habit) != 0; }
    /// Ratio of peak-to-peak voltage to the displayed number.
    double volts() const {
        const double crest = shape_ == "SIN"    ? std::sqrt(8.0)
                             : shape_ == "SQU"  ? 2
                             : shape_ == "NOIS" ? 7
                                                : std::sqrt(12.0);
        if (unit_ == "VPP")
            return 1;
        if (unit_ == "VRMS")
            return crest;
        return crest * std::sqrt(0.05 * std::pow(10.0, number_ / 10)) / number_;
    }
    double inner() const { return load_ > 1e9 ? 1 : 1 + 50 / load_; }
    double divider() const { return real_load_ > 1e9 ? 1 : real_load_ / (50 + real_load_); }
    std::string refuse(const char* error) {
        errors_.emplace_back(error);
        return "";
    }
    /// Changes unit, shape or load so that the output stays the same, unless the habit is to keep the number.
    template <class Change>
    std::string change(Habit stuck, const Change& make) {
        if (has(stuck))
            return "";
        const double inside = number_ * volts() * inner(), aside = offset_ * inner();
        make();
        if (has(keeps_numbers)) {
            number_ = std::max(number_, unit_ == "DBM" ? -60.0 : 1e-3);
        } else {
            number_ = unit_ != "DBM" ? inside / inner() / volts() : -20;
            offset_ = aside / inner();
        }
        return "";
    }
    std::string obey(const std::string& command, const std::string& argument) {
        const bool asks = command.back() == '?';
        const std::string name = asks ? command.substr(0, command.size() - 1) : command;
        if (name == "*IDN")
            return "STRANGER,1,2,3";
        if (name == "*CLS" || name == "SYST:REM" || name == "SYST:LOC") {
            if (name == "*CLS")
                errors_.clear();
            return "";
        }
        if (name == "SYST:ERR") {
            const std::string error = errors_.empty() ? "0,\"No error\"" : errors_.front();
            if (!errors_.empty())
                errors_.erase(errors_.begin());
            return error;
        }
        if (name == "OUTP" && has(has_switch)) {
            if (asks)
                return on_ ? "1" : "0";
            on_ = argument == "ON";
            if (on_ && has(switch_recalls))
                number_ = 7;
            return "";
        }
        if (name == "VOLT:UNIT")
            return asks ? unit_ : change(unit_is_stuck, [&] { unit_ = argument; });
        if (name == (has(short_function) ? "FUNC" : "FUNC:SHAP"))
            return asks ? shape_ : change(shape_is_stuck, [&] { shape_ = argument; });
        if (name == "OUTP:LOAD")
            return asks ? fmt::format("{:.7e}", load_)
                        : change(load_is_stuck, [&] { load_ = argument == "INF" ? 9.9e37 : std::stod(argument); });
        if (name == "AM:STAT" || name == "BURS:STAT" || name == "SWE:STAT" || name == "SUM:STAT") {
            const std::string which = name.substr(0, name.find(':'));
            if (asks)
                return modulation_ == which ? "1" : "0";
            if (modulation_ == which && !has(modulation_is_stuck))
                modulation_.clear();
            return "";
        }
        double* const value = name == "VOLT"        ? &number_
                              : name == "VOLT:OFFS" ? &offset_
                              : name == "FREQ"      ? &frequency_
                                                    : nullptr;
        if (value == nullptr)
            return refuse("-113,\"Undefined header\"");
        if (asks)
            return fmt::format("{:.7e}", *value);
        if (argument == "MIN") {
            if (!has(knows_minimum) || name != "VOLT")
                return refuse("-224,\"Illegal parameter value\"");
            number_ = unit_ == "DBM" ? -60 : 1e-3;
            return "";
        }
        *value = std::stod(argument);
        if (name == "FREQ" && has(frequency_resets))
            number_ = 10;
        if (name == "VOLT" && has(amplitude_shifts))
            offset_ = 1;
        return "";
    }

    unsigned habits_;
    double real_load_;
    std::string unit_, shape_, modulation_;
    double load_ = 50, number_ = 0, offset_ = 0, frequency_ = 1;
    bool on_ = true;
    std::vector<std::string> errors_;
};

} // namespace graze::testing

#include "instrument/function_generator.hpp"

#include "base/letter_case.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/trimmed.hpp"
#include "instrument/scpi_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr std::size_t most_errors = 20;
constexpr double least_frequency = 1e-4, most_frequency = 15e6; // of a sine
constexpr double least_amplitude = GeneratorOutput::least_amplitude, most_amplitude = GeneratorOutput::most_amplitude;
constexpr double most_voltage = 5; // limit of offset plus half the amplitude
constexpr std::string_view identity = "HEWLETT-PACKARD,33120A,0,8.0-5.0-2.0";

// Bits of the standard event register (IEEE 488.2).
constexpr int operation_complete = 1, query_error = 4, device_error = 8, execution_error = 16, command_error = 32;

int event_of(int error) {
    return error > 0       ? device_error
           : error <= -400 ? query_error
           : error <= -300 ? device_error
           : error <= -200 ? execution_error
                           : command_error;
}

} // namespace

FunctionGenerator::FunctionGenerator(const GeneratorSettings& settings) : settings_(settings) {
    if (!(settings.clip > 0))
        throw InputError(fmt::format("the generator cuts down to {} V", settings.clip), "give a positive amplitude");
    if (settings.left_as.empty())
        return;
    remote_ = true;
    execute(settings.left_as);
    if (!errors_.empty())
        throw InputError(fmt::format("the generator cannot be left by '{}': {:+d},\"{}\"", settings.left_as,
                                     errors_.front(), scpi_error_text(errors_.front())),
                         "give commands that it knows, as VOLT:UNIT VRMS;:VOLT 2;:FUNC:SHAP SQU");
    remote_ = false;
}

struct FunctionGenerator::Unit {
    std::string header;                 ///< in capitals, from the root, without the question mark
    std::vector<std::string> arguments; ///< in capitals
    bool query = false;
    std::string answer{};
};

struct FunctionGenerator::Command {
    std::string_view pattern;
    bool query, set;         ///< whether it exists as a query and as a command
    std::size_t least, most; ///< number of arguments of the command
    void (FunctionGenerator::*work)(Unit&);
    bool in_local = false; ///< whether it is accepted before SYST:REM
};

std::span<const FunctionGenerator::Command> FunctionGenerator::commands() {
    using Self = FunctionGenerator;
    static constexpr std::array<Command, 27> known{{
        {"SYSTem:REMote", false, true, 0, 0, &Self::remote, true},
        {"SYSTem:RWLock", false, true, 0, 0, &Self::remote, true},
        {"SYSTem:LOCal", false, true, 0, 0, &Self::remote, true},
        {"SYSTem:BEEPer", false, true, 0, 0, &Self::common},
        {"SYSTem:ERRor", true, false, 0, 0, &Self::error_query},
        {"*CLS", false, true, 0, 0, &Self::common, true},
        {"*IDN", true, false, 0, 0, &Self::common},
        {"*RST", false, true, 0, 0, &Self::common},
        {"*OPC", true, true, 0, 0, &Self::common},
        {"*TST", true, false, 0, 0, &Self::common},
        {"*ESR", true, false, 0, 0, &Self::common},
        {"*WAI", false, true, 0, 0, &Self::common},
        {"APPLy", true, false, 0, 0, &Self::apply},
        {"APPLy:SINusoid", false, true, 0, 3, &Self::apply},
        {"FREQuency", true, true, 1, 1, &Self::frequency},
        {"VOLTage", true, true, 1, 1, &Self::amplitude},
        {"VOLTage:OFFSet", true, true, 1, 1, &Self::offset},
        {"VOLTage:UNIT", true, true, 1, 1, &Self::voltage_unit},
        {"FUNCtion:SHAPe", true, true, 1, 1, &Self::shape},
        {"OUTPut:LOAD", true, true, 1, 1, &Self::load},
        {"AM:STATe", true, true, 1, 1, &Self::modulation},
        {"FM:STATe", true, true, 1, 1, &Self::modulation},
        {"FSKey:STATe", true, true, 1, 1, &Self::modulation},
        {"BM:STATe", true, true, 1, 1, &Self::modulation},
        {"SWEep:STATe", true, true, 1, 1, &Self::modulation},
        {"*SRE", true, true, 1, 1, &Self::common},
        {"*ESE", true, true, 1, 1, &Self::common},
    }};
    return known;
}

void FunctionGenerator::note_error(int number) {
    events_ |= event_of(number);
    if (errors_.size() < most_errors)
        errors_.push_back(number);
    else
        errors_.back() = -350;
}

std::string FunctionGenerator::execute(std::string_view line) {
    if (line.size() > longest_line) {
        note_error(521);
        return {};
    }
    std::string answers, path;
    if (trimmed(line).empty())
        return answers;
    for (std::string_view text : parts(line, ';')) {
        if (text.empty()) {
            note_error(-102);
            continue;
        }
        const auto is_wrong = [](char letter) {
            return static_cast<unsigned char>(letter) < 0x20 || letter == '\x7f' ||
                   static_cast<unsigned char>(letter) > 0x7f;
        };
        if (std::any_of(text.begin(), text.end(), is_wrong)) {
            note_error(-101);
            continue;
        }
        Unit unit;
        const std::size_t blank = std::min(text.find_first_of(" \t"), text.size());
        unit.header = in_capitals(text.substr(0, blank));
        if (const std::string_view rest = trimmed(text.substr(blank)); !rest.empty())
            for (const std::string_view argument : parts(rest, ','))
                unit.arguments.push_back(in_capitals(argument));
        unit.query = unit.header.ends_with('?');
        if (unit.query)
            unit.header.pop_back();
        if (!unit.header.starts_with('*')) { // headers are relative to the path of the one before
            unit.header = unit.header.starts_with(':') ? unit.header.substr(1) : path + unit.header;
            const std::size_t last = unit.header.rfind(':');
            path = last == std::string::npos ? std::string() : unit.header.substr(0, last + 1);
        }
        for (const std::string_view source : {"SOURCE:", "SOUR:"})
            if (unit.header.starts_with(source))
                unit.header.erase(0, source.size());
        execute_unit(unit);
        if (!unit.answer.empty())
            answers += (answers.empty() ? "" : ";") + unit.answer;
    }
    return answers;
}

void FunctionGenerator::execute_unit(Unit& unit) {
    for (const Command& command : commands()) {
        if (!matches(unit.header, command.pattern) || !(unit.query ? command.query : command.set))
            continue;
        const std::size_t count = unit.arguments.size();
        const bool of_limit = unit.query && count == 1 && (unit.arguments[0] == "MIN" || unit.arguments[0] == "MAX");
        if (unit.query ? count > 0 && !(of_limit && command.set) : count > command.most)
            return note_error(-108);
        if (!unit.query && count < command.least)
            return note_error(-109);
        if (!unit.query && !remote_ && !command.in_local)
            return note_error(550);
        return (this->*command.work)(unit);
    }
    note_error(-113);
}

void FunctionGenerator::remote(Unit& unit) {
    remote_ = !matches(unit.header, "SYSTem:LOCal");
}

void FunctionGenerator::error_query(Unit& unit) {
    const int number = errors_.empty() ? 0 : errors_.front();
    if (!errors_.empty())
        errors_.erase(errors_.begin());
    unit.answer = fmt::format("{:+d},\"{}\"", number, scpi_error_text(number));
}

void FunctionGenerator::common(Unit& unit) {
    const std::string& name = unit.header;
    if (name == "*CLS") {
        errors_.clear();
        events_ = 0;
    } else if (name == "*IDN") {
        unit.answer = identity;
    } else if (name == "*RST") {
        output_ = {};
        high_load_ = false;
        unit_ = VoltageUnit::vpp;
        modulations_.clear();
    } else if (name == "*OPC" && !unit.query) {
        events_ |= operation_complete;
    } else if (name == "*OPC") {
        unit.answer = "1";
    } else if (name == "*ESR") {
        unit.answer = fmt::format("{:+d}", std::exchange(events_, 0));
    } else if (unit.query) {
        unit.answer = "+0";
    }
}

/// Parses a number with its unit. @param least, most values of MIN and MAX @param unit of a voltage without one; none:
/// it is a frequency @param value in Hz, or in V peak to peak. @return false for an invalid number or unit
bool FunctionGenerator::read_number(const std::string& text, std::optional<VoltageUnit> unit, double least, double most,
                                    double& value) {
    if (is_form_of(text, "MINimum") || is_form_of(text, "MAXimum")) {
        value = text.starts_with("MIN") ? least : most;
        return true;
    }
    const char* const end = text.data() + text.size();
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || !std::isfinite(value)) {
        note_error(error == std::errc::result_out_of_range ? -222 : -104);
        return false;
    }
    const std::string_view suffix = trimmed({next, static_cast<std::size_t>(end - next)});
    static constexpr std::array<std::pair<std::string_view, double>, 4> of_frequency{
        {{"", 1}, {"HZ", 1}, {"KHZ", 1e3}, {"MHZ", 1e6}}};
    for (const auto& [name, factor] : of_frequency)
        if (!unit && name == suffix) {
            value *= factor;
            return true;
        }
    if (unit && read_voltage(suffix, *unit, output_.shape, value))
        return true;
    note_error(-131);
    return false;
}

/// Sets the displayed voltages. The amplitude has priority: an offset beyond the remaining range is reduced.
bool FunctionGenerator::set_voltages(double amplitude, double offset) {
    const double factor = load_factor();
    if (!GeneratorOutput::reaches(amplitude / factor)) {
        note_error(-222);
        return false;
    }
    const double room = std::max(0.0, most_voltage * factor - amplitude / 2);
    const double allowed = settings_.takes_offset ? std::min(room, 2 * amplitude) : 0;
    if (std::abs(offset) > allowed) {
        note_error(-221);
        offset = std::copysign(allowed, offset);
    }
    output_.amplitude = std::min(amplitude, settings_.clip) / factor;
    output_.offset = offset / factor;
    return true;
}

void FunctionGenerator::apply(Unit& unit) {
    const double factor = load_factor();
    if (unit.query) {
        shape(unit);
        unit.answer =
            fmt::format("\"{} {:+.12E},{:+.6E},{:+.6E}\"", unit.answer, output_.frequency,
                        shown_voltage(output_.amplitude * factor, unit_, output_.shape), output_.offset * factor);
        return;
    }
    const WaveShape before = std::exchange(output_.shape, WaveShape::sine); // amplitudes refer to a sine
    constexpr double usual_frequency = 1000, usual_amplitude = 0.1;
    std::array<double, 3> values{usual_frequency, usual_amplitude * factor, 0};
    const std::array<std::pair<double, double>, 3> limits{{{least_frequency, most_frequency},
                                                           {least_amplitude * factor, most_amplitude * factor},
                                                           {-most_voltage * factor, most_voltage * factor}}};
    const std::optional<VoltageUnit> units[]{std::nullopt, unit_, VoltageUnit::vpp}; // an offset is in V
    bool good = true;
    for (std::size_t i = 0; i < unit.arguments.size() && good; ++i) {
        good = is_form_of(unit.arguments[i], "DEFault") ||
               read_number(unit.arguments[i], units[i], limits[i].first, limits[i].second, values[i]);
    }
    if (good && !(values[0] >= least_frequency && values[0] <= most_frequency)) {
        note_error(-222);
        good = false;
    }
    if (!good || !set_voltages(values[1], values[2])) {
        output_.shape = before;
        return;
    }
    output_.frequency = values[0];
    modulations_.clear();
}

void FunctionGenerator::frequency(Unit& unit) {
    double value = output_.frequency;
    if (!unit.arguments.empty() &&
        !read_number(unit.arguments[0], std::nullopt, least_frequency, most_frequency, value))
        return;
    if (unit.query)
        unit.answer = fmt::format("{:+.12E}", value);
    else if (value >= least_frequency && value <= most_frequency)
        output_.frequency = value;
    else
        note_error(-222);
}

void FunctionGenerator::amplitude(Unit& unit) {
    const double factor = load_factor();
    double value = output_.amplitude * factor;
    if (!unit.arguments.empty() &&
        !read_number(unit.arguments[0], unit_, least_amplitude * factor, most_amplitude * factor, value))
        return;
    if (unit.query)
        unit.answer = fmt::format("{:+.6E}", shown_voltage(value, unit_, output_.shape));
    else
        set_voltages(value, output_.offset * factor);
}

void FunctionGenerator::offset(Unit& unit) {
    const double factor = load_factor();
    double value = output_.offset * factor;
    if (!unit.arguments.empty() && !read_number(unit.arguments[0], VoltageUnit::vpp, -most_voltage * factor,
                                                most_voltage * factor, value)) // always in volts
        return;
    if (unit.query)
        unit.answer = fmt::format("{:+.6E}", value);
    else if (std::abs(value) > most_voltage * factor)
        note_error(-222);
    else
        set_voltages(output_.amplitude * factor, value);
}

void FunctionGenerator::voltage_unit(Unit& unit) {
    if (unit.query)
        unit.answer = name_of(unit_);
    else if (is_form_of(unit.arguments[0], "DEFault"))
        unit_ = VoltageUnit::vpp;
    else if (unit.arguments[0] == "DBM" && high_load_)
        note_error(-221); // a power needs a load of 50 ohm
    else if (const std::optional<VoltageUnit> asked = voltage_unit_named(unit.arguments[0]))
        unit_ = *asked;
    else
        note_error(-224);
}

void FunctionGenerator::shape(Unit& unit) {
    static constexpr std::array<std::pair<std::string_view, WaveShape>, 5> known{{{"SINusoid", WaveShape::sine},
                                                                                  {"SQUare", WaveShape::square},
                                                                                  {"TRIangle", WaveShape::triangle},
                                                                                  {"RAMP", WaveShape::ramp},
                                                                                  {"DC", WaveShape::dc}}};
    for (const auto& [form, shape] : known) {
        if (unit.query && shape == output_.shape)
            unit.answer = std::string(form.substr(0, form == "RAMP" ? 4 : 3));
        if (!unit.query && is_form_of(unit.arguments[0], form)) {
            output_.shape = shape; // the peak-to-peak amplitude is kept
            return;
        }
    }
    if (!unit.query)
        note_error(-224);
}

void FunctionGenerator::modulation(Unit& unit) {
    const std::string name = unit.header.substr(0, 2); // AM, FM, FS, BM, SW
    const auto found = std::find(modulations_.begin(), modulations_.end(), name);
    if (unit.query) {
        unit.answer = found == modulations_.end() ? "0" : "1";
    } else if (unit.arguments[0] == "ON" || unit.arguments[0] == "1") {
        modulations_.assign({name}); // only one at a time
    } else if (unit.arguments[0] != "OFF" && unit.arguments[0] != "0") {
        note_error(-224);
    } else if (found != modulations_.end()) {
        modulations_.erase(found);
    }
}

void FunctionGenerator::load(Unit& unit) {
    if (unit.query)
        unit.answer = high_load_ ? "+9.90000E+37" : "+5.00000E+01";
    else if (unit.arguments[0] == "50" || is_form_of(unit.arguments[0], "MINimum"))
        high_load_ = false;
    else if (is_form_of(unit.arguments[0], "INFinity") || is_form_of(unit.arguments[0], "MAXimum")) {
        high_load_ = true;
        if (unit_ == VoltageUnit::dbm)
            unit_ = VoltageUnit::vpp;
    } else {
        note_error(-224);
    }
}

} // namespace graze

#pragma once

#include "graze/bench/generator_output.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Unit of amplitudes: peak to peak, root mean square, or power at 50 ohm relative to a milliwatt.
enum class VoltageUnit { vpp, vrms, dbm };

/// Deviations of the simulated generator from a faultless one.
struct GeneratorSettings {
    bool takes_offset = true; ///< false: every offset but 0 conflicts with other settings
    /// Largest amplitude of its output: larger ones are accepted without an error and clipped, which only reading back
    /// reveals.
    double clip = std::numeric_limits<double>::infinity();
    /// A line of commands that is executed at the start: the state in which a previous user left it.
    std::string left_as{};
};

/// A simulated SCPI function generator with commands, settings and errors of Hewlett-Packard's 33120A, as its user's
/// guide describes them for RS-232. It maps lines to lines, without time, input or output.
///
/// It understands SYST:REM, SYST:LOC, SYST:RWL, SYST:ERR?, SYST:BEEP, *CLS, *IDN?, *RST, *OPC, *OPC?, *TST?, *WAI,
/// *ESR?, APPL:SIN f, vpp, offset, APPL?, FREQ, VOLT, VOLT:OFFS, VOLT:UNIT (VPP, VRMS or DBM), FUNC:SHAP (SIN, SQU,
/// TRI, RAMP or DC), OUTP:LOAD 50 or INF, and the switches of modulations AM:STAT, FM:STAT, FSK:STAT, BM:STAT and
/// SWE:STAT, with queries, MIN, MAX and DEF, units, long and short forms, a leading SOUR:, and several commands in a
/// line. A value out of range (-222) changes nothing. Modulations are switches without an effect.
class FunctionGenerator {
public:
    /// @throws InputError for a clip that is not positive, and when `left_as` causes an error
    explicit FunctionGenerator(const GeneratorSettings& settings = {});

    /// Executes a line. @return its answer without a terminator, answers to several queries separated by semicolons;
    /// empty: none
    std::string execute(std::string_view line);
    /// Queues an error, such as 521 for a line that is too long.
    void note_error(int number);

    /// The output at a load of 50 ohm; the load that it was told does not change it.
    const GeneratorOutput& output() const { return output_; }
    /// Whether SYST:REM has been given; nothing can be set before.
    bool is_remote() const { return remote_; }
    /// Unread errors: the oldest 20, of which the last is -350 when there were more.
    std::span<const int> errors() const { return errors_; }

    static constexpr std::size_t longest_line = 256; ///< bytes; a longer line is error 521

private:
    struct Unit;    // one command of a line, with its arguments
    struct Command; // an entry of the table of commands
    static std::span<const Command> commands();
    void execute_unit(Unit& unit);
    bool read_number(const std::string& text, std::optional<VoltageUnit> unit, double least, double most,
                     double& value);
    bool set_voltages(double amplitude, double offset);
    double load_factor() const { return high_load_ ? 2 : 1; }

    void remote(Unit& unit);
    void error_query(Unit& unit);
    void common(Unit& unit);
    void apply(Unit& unit);
    void frequency(Unit& unit);
    void amplitude(Unit& unit);
    void offset(Unit& unit);
    void voltage_unit(Unit& unit);
    void shape(Unit& unit);
    void load(Unit& unit);
    void modulation(Unit& unit);

    GeneratorSettings settings_;
    GeneratorOutput output_;
    VoltageUnit unit_ = VoltageUnit::vpp;
    bool remote_ = false, high_load_ = false;
    std::vector<std::string> modulations_; ///< modulations that are on
    int events_ = 0;                       ///< standard event register
    std::vector<int> errors_;
};

} // namespace graze

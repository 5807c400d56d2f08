#pragma once

#include "graze/bench/generator_output.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// In which amplitudes are told and shown: from peak to peak, root mean square, or power at 50 ohm above a milliwatt.
enum class VoltageUnit { vpp, vrms, dbm };

/// In what a generator differs from a whole one.
struct GeneratorSettings {
    bool takes_offset = true; ///< without it every offset but 0 is in conflict with other settings
    /// The largest amplitude that it gives, whatever it accepts: larger ones are cut down without an error, and only
    /// what it tells of itself shows it.
    double clip = std::numeric_limits<double>::infinity();
    /// A line of commands that has been carried out before anybody comes: as whoever used it last has left it.
    std::string left_as{};
};

/// What a generator answers to SCPI: commands, settings and errors of Hewlett-Packard's 33120A, as its user's
/// guide describes them for the RS-232 interface. Lines in, lines out; no time, no input or output.
///
/// Known are SYST:REM, SYST:LOC, SYST:RWL, SYST:ERR?, SYST:BEEP, *CLS, *IDN?, *RST, *OPC, *OPC?, *TST?, *WAI, *ESR?,
/// APPL:SIN f, vpp, offset, APPL?, FREQ, VOLT, VOLT:OFFS, VOLT:UNIT (VPP, VRMS or DBM), FUNC:SHAP (SIN, SQU, TRI, RAMP
/// or DC), OUTP:LOAD 50 or INF, and the switches of modulations AM:STAT, FM:STAT, FSK:STAT, BM:STAT and SWE:STAT, with
/// what goes with them: queries, MIN, MAX and DEF, units, long and short forms, SOUR: before them, several commands in
/// a line. A value out of range (-222) changes nothing. Modulations are switches here that do nothing else.
class FunctionGenerator {
public:
    /// @throws InputError for a clip that is not positive, and when it has an error after the line that it was left by
    explicit FunctionGenerator(const GeneratorSettings& settings = {});

    /// Does what a line asks for. @return its answer without a terminator, answers to several queries separated by
    /// semicolons; empty: none
    std::string execute(std::string_view line);
    /// Notes an error that was found before the line was whole, such as 521 of a line that is too long.
    void note_error(int number);

    /// As under a load of 50 ohm, whatever load it was told of: what the output gives does not change with that.
    const GeneratorOutput& output() const { return output_; }
    /// Whether SYST:REM has been given; before that nothing can be set.
    bool is_remote() const { return remote_; }
    /// Errors that have not been read yet: the oldest 20, of which the last is -350 when there were more.
    std::span<const int> errors() const { return errors_; }

    static constexpr std::size_t longest_line = 256; ///< bytes; longer ones are error 521

private:
    struct Unit;    // of a line: one command with its arguments
    struct Command; // that is known
    static std::span<const Command> commands();
    void execute_unit(Unit& unit);
    void raise(int number);
    bool read_number(const std::string& text, bool is_frequency, double least, double most, double& value);
    bool set_voltages(double amplitude, double offset);
    double load_factor() const { return high_load_ ? 2 : 1; }
    double shown_amplitude() const;
    void reset();

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
    std::vector<std::string> modulations_; ///< that are on
    int events_ = 0;                       ///< register of standard events
    std::vector<int> errors_;
};

/// What goes with an error number of SCPI, such as "Undefined header".
std::string_view scpi_error_text(int number);

} // namespace graze

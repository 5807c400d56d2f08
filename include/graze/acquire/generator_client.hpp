#pragma once

#include "graze/acquire/instrument_line.hpp"
#include "graze/base/require.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

/// Limits of the generator's output, in volts at the load GeneratorOptions::load.
struct GeneratorLimits {
    double amplitude = 0; ///< largest amplitude, in V peak to peak
    double offset = 0;    ///< largest magnitude of the offset, in V
    double least_frequency = 0, greatest_frequency = std::numeric_limits<double>::infinity(); ///< in Hz
};

/// Options of `GeneratorClient`.
struct GeneratorOptions {
    GeneratorLimits limits{};
    double load = 50;        ///< load of the output in ohm; infinity: high impedance
    double timeout = 2;      ///< longest wait for an answer, in s
    int attempts = 3;        ///< attempts for each setting if lines are lost or garbled
    double tolerance = 1e-3; ///< relative tolerance when a setting is read back
    std::string identity{};  ///< text that its answer to *IDN? must contain
    double reopen = 5;       ///< time in s for which a lost line is reopened in order to make the output safe
    std::function<bool()> interrupted{};
};

/// Controls a function generator by SCPI over a line. Every setting is read back, and so are errors: a setting is
/// accepted only when the generator itself reports it.
///
/// A number of volts is ambiguous until unit, wave shape, load and modulations are known. These are set and read back
/// before the first level is sent, and read again before and after each level. If they are wrong, no level is sent.
class GeneratorClient {
public:
    /// @param line is shared. @throws InputError for a null pointer
    GeneratorClient(std::shared_ptr<InstrumentLine> line, GeneratorOptions options)
        : line_(required(std::move(line), "a line")), options_(std::move(options)) {}

    /// Checks the generator's identity. Nothing is set before that, not even to make the output safe. @throws
    /// InstrumentError
    void identify();
    /// Takes remote control, switches the output off (without a switch: sets the least amplitude), sets a plain sine in
    /// volts peak to peak at the load and the levels, and switches the output on.
    /// @throws InstrumentError, here and below, when the generator does not answer, refuses, or reports another
    /// setting; InputError for values beyond the limits, which are never sent
    void begin(double frequency, double amplitude, double offset);
    /// Sets the amplitude. All other settings are read back before and after it.
    /// @return the amplitude that the generator reports
    double set_amplitude(double amplitude);
    /// Sets the frequency. The amplitude is read back first of all: a larger one than was set silences the output at
    /// once.
    double set_frequency(double frequency);
    /// Returns the present amplitude. Unit, shape, load, modulations, offset and frequency are read back, too.
    double amplitude();
    /// The generator's answer to *IDN?.
    const std::string& identity() const { return identity_; }

    /// Brings the output to a safe amplitude without offset from any state; reopens a lost line. A generator that is no
    /// longer as `begin` left it is switched off as well, if it has a switch. Cannot be interrupted. @return whether
    /// the generator reports that amplitude; if not, `problem` says why
    bool make_safe(double amplitude, std::string& problem) noexcept;
    /// Switches the output off if it could not be made safe. Cannot be interrupted.
    /// @return whether the generator reports that its output is off
    bool is_switched_off() noexcept;

private:
    struct Setting; // a numeric setting
    static const Setting of_amplitude, of_offset, of_frequency;
    /// A setting chosen from words, or a load.
    struct Choice {
        std::string command, value;                       ///< command and value that are sent
        std::function<bool(const std::string&)> is_right; ///< checks the answer, in capitals
    };
    std::string asked(std::string_view question);
    double asked_number(std::string_view question);
    int asked_error(std::string& text);
    template <class Work>
    void attempt(const Work& work, int factor = 1);
    double set(const Setting& setting, double value, const std::function<void()>& at_once = {});
    double checked(const Setting& setting, double value);
    bool is_in_step();
    bool choose(const Choice& choice, bool needed);
    void require(const Choice& choice);
    void take_control();
    void switch_off();
    void prepare(double safe);
    void quieten(double safe);
    bool is_understood(std::string_view command);
    void lower(double safe);
    void require_quiet(double number);
    void require_plain();
    void require_beside_amplitude();
    void silence();
    void check_no_more();
    void check_level();
    void switch_on();
    void try_safe(double amplitude);

    std::shared_ptr<InstrumentLine> line_;
    GeneratorOptions options_;
    std::string identity_;
    bool identified_ = false;
    bool making_safe_ = false;
    std::vector<Choice> chosen_; ///< settings that make a plain sine in volts, as far as the generator has them
    bool has_switch_ = false;    ///< the output has a switch
    bool plain_ = false;         ///< all of `chosen_` has been read back
    bool is_on_ = false;         ///< its switch is on
    bool silenced_ = false;      ///< it was silenced, as it gave too much
    double least_ = 0;           ///< V peak to peak: amplitude before the first level
    double amplitude_ = 0, offset_ = 0, frequency_ = 0; ///< values set last, in V and Hz
};

} // namespace graze

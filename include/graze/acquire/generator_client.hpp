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

/// What must never leave a generator, in volts at a load of GeneratorOptions::load.
struct GeneratorLimits {
    double amplitude = 0; ///< largest, in V from peak to peak
    double offset = 0;    ///< largest of either sign, in V
    double least_frequency = 0, greatest_frequency = std::numeric_limits<double>::infinity(); ///< in Hz
};

struct GeneratorOptions {
    GeneratorLimits limits;
    double load = 50;        ///< ohm, at the output; infinity: one of high impedance
    double timeout = 2;      ///< s, for each answer
    int attempts = 3;        ///< at each setting, where lines are lost or garbled
    double tolerance = 1e-3; ///< of what it tells of a setting, relative to it
    std::string identity{};  ///< what it answers to *IDN? must have this in it
    double reopen = 5;       ///< s, for which a lost line is tried again so that the output becomes safe
    std::function<bool()> interrupted{};
};

/// A function generator at the end of a line, spoken to in SCPI. What is set is asked for again, and so are errors: a
/// setting counts when the generator itself tells it.
///
/// A number of volts means nothing before it is known what the generator takes it for. Unit, wave shape, load and the
/// switches of modulations are set and asked for again before the first level is sent, and asked for anew before and
/// after each of them. Where they are not as they should be no level is sent.
class GeneratorClient {
public:
    /// @param line is shared. @throws InputError where there is none
    GeneratorClient(std::shared_ptr<InstrumentLine> line, GeneratorOptions options)
        : line_(required(std::move(line), "a line")), options_(std::move(options)) {}

    /// Asks what it is. Nothing is set before, neither here nor in order to become safe. @throws InstrumentError
    void identify();
    /// Takes it under remote control, switches its output off (where it has a switch; else the amplitude goes to its
    /// least one), makes it a plain sine in volts from peak to peak at the load, sets its levels, and switches it on.
    /// All of that is asked for again directly before the output is switched on and directly after; what is not as it
    /// was told switches it off at once. `amplitude` is a safe one.
    /// @throws InstrumentError, here and below, when it does not answer, refuses, or gives something else;
    ///         InputError for what is beyond the limits, of which nothing is sent
    void begin(double frequency, double amplitude, double offset);
    /// Before it and after it all else that makes up the level is asked for, too.
    /// @return what the generator says that it gives
    double set_amplitude(double amplitude);
    /// Asks for the amplitude, too, before anything else: a larger one than was told silences the output at once.
    double set_frequency(double frequency);
    /// What it gives now. Unit, shape, load, modulations, offset and frequency are asked for, too.
    double amplitude();
    double frequency();
    /// What it answers to *IDN?.
    const std::string& identity() const { return identity_; }

    /// Brings the output to a safe amplitude without offset, whatever has happened before; opens a lost line again.
    /// A generator that no longer stands as `begin` has left it is switched off besides, if it has a switch.
    /// Nobody can interrupt it. @return whether the generator says that it is there; if not, `problem` says why
    bool make_safe(double amplitude, std::string& problem) noexcept;
    /// Where it could not be made safe: switches the output off once more. Nobody can interrupt it.
    /// @return whether the generator itself says that its output is off
    bool is_switched_off() noexcept;

private:
    struct Setting; // of a number
    /// Among words, or of a load.
    struct Choice {
        std::string command, value;                       ///< what is sent
        std::function<bool(const std::string&)> is_right; ///< about the answer, in capitals
    };
    std::string asked(std::string_view question);
    double asked_number(std::string_view question);
    int asked_error(std::string& text);
    template <class Work>
    void attempt(const Work& work, int factor = 1);
    double set(const Setting& setting, double value, const std::function<void()>& at_once = {});
    void check(const Setting& setting, double value);
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
    std::vector<Choice> chosen_; ///< what makes it a plain sine in volts, as far as the generator knows of it
    bool has_switch_ = false;    ///< of its output
    bool plain_ = false;         ///< all that was chosen has been told by the generator
    bool is_on_ = false;         ///< its switch
    bool silenced_ = false;      ///< it has given too much
    double least_ = 0;           ///< in V from peak to peak: what it gives before the first level
    double amplitude_ = 0, offset_ = 0, frequency_ = 0; ///< as they were told last, in V and Hz
};

} // namespace graze

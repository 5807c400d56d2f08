#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/generator_client.hpp"
#include "graze/acquire/record_folder.hpp"
#include "graze/acquire/sample_device.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace graze {

/// What an acquisition is doing; `walking` is the repetition of earlier levels without records.
enum class AcquisitionStage { walking, setting, settling, recording };
std::string_view name_of(AcquisitionStage stage);

/// State of a running acquisition, passed to AcquisitionOptions::progress.
struct AcquisitionProgress {
    AcquisitionStage stage = AcquisitionStage::setting;
    Level level;
    std::size_t levels = 0, recorded = 0;
    double time = 0; ///< duration of the present stage so far, in s
};

/// Callbacks of `acquire`; all may be empty.
struct AcquisitionOptions {
    /// Called some twenty times a second while waiting; returning true ends the acquisition.
    std::function<bool()> interrupted{};
    std::function<void(const AcquisitionProgress&)> progress{};
    /// Called before the first setting is sent: from then on the generator may be in any state.
    std::function<void()> begun{};
    /// Called after each record has been committed.
    std::function<void(const RecordEntry&)> recorded{};
};

/// Result of `acquire`.
struct AcquisitionReport {
    AcquisitionEnding ending = AcquisitionEnding::complete;
    std::string detail;         ///< why it ended, in one line; empty when complete
    std::size_t before = 0;     ///< number of records that existed before
    std::size_t recorded = 0;   ///< number of records that were added
    std::size_t unsettled = 0;  ///< number of these whose sections did not repeat
    bool safe = true;           ///< the generator has confirmed the safe amplitude
    std::string unsafe_because; ///< why it has not
    bool off = false;           ///< if not safe: the generator has confirmed that its output is switched off instead
};

/// Runs an experiment: steps a generator from level to level, waits, and records, until all records exist; existing
/// records are kept. Whatever happens, even an exception, the generator is brought to the safe amplitude before this
/// returns, or the report says that this failed.
///
/// To resume an experiment, the device is returned to its stored state if it can (SampleDevice::return_to); otherwise
/// the earlier levels are repeated without records, so that the system approaches the next one from the same side.
/// @param options the generator's other options are those of the experiment
/// @throws InputError when a record cannot be written, or the device lacks a channel; what a callback throws. Where the
///         output could not be made safe nothing is thrown: `detail` then tells it
AcquisitionReport acquire(const Experiment& experiment, InstrumentLine& generator, SampleDevice& device,
                          RecordFolder& folder, const AcquisitionOptions& options = {});

/// Whether the output of an experiment's generator is safe, as the generator tells itself.
struct SafeOutput {
    bool safe = false;   ///< it has the safe amplitude
    bool off = false;    ///< if not: it is switched off
    std::string problem; ///< if not: why
};

/// Opens the line to the generator of an experiment that nobody controls any more, and brings its output to the safe
/// amplitude. Cannot be interrupted. What fails is told in the result.
SafeOutput make_safe(const Experiment& experiment);

} // namespace graze

#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/generator_client.hpp"
#include "graze/acquire/record_folder.hpp"
#include "graze/acquire/sample_device.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace graze {

enum class AcquisitionStage { walking, setting, settling, recording };

struct AcquisitionProgress {
    AcquisitionStage stage = AcquisitionStage::setting;
    Level level;
    std::size_t levels = 0, recorded = 0;
    double time = 0; ///< s, of what is going on
};

struct AcquisitionOptions {
    std::function<bool()> interrupted{};
    std::function<void(const AcquisitionProgress&)> progress{};
    /// Called before the first setting is sent: from then on the generator may be in any state.
    std::function<void()> begun{};
    /// Told of each record as soon as it counts.
    std::function<void(const RecordEntry&)> recorded{};
};

/// What became of an experiment.
struct AcquisitionReport {
    AcquisitionEnding ending = AcquisitionEnding::complete;
    std::string detail;         ///< in one line; empty when complete
    std::size_t before = 0;     ///< records that were there
    std::size_t recorded = 0;   ///< that have been added
    std::size_t unsettled = 0;  ///< of these, without sections that repeat
    bool safe = true;           ///< the generator itself has told its safe amplitude
    std::string unsafe_because; ///< where it has not
    bool off = false;           ///< where it has not: it has told that its output is switched off instead
};

/// Steps a generator from level to level, waits, records, until all records are there; those that are there already are
/// passed over. Whatever happens, an exception included, the generator is brought to the safe amplitude before this
/// returns, or it is said that it could not be.
///
/// To go on in the middle, a device that can (SampleDevice::return_to) is brought back to how it was; with others the
/// levels before are walked through again, so that the system comes to the next one from the side that it would have.
/// @param options of the generator's are those of the experiment, except for the interruption
/// @throws InputError when a record cannot be written, or the device lacks a channel; what a callback throws. Where the
///         output could not be made safe nothing is thrown: `detail` then tells it
AcquisitionReport acquire(const Experiment& experiment, InstrumentLine& generator, SampleDevice& device,
                          RecordFolder& folder, const AcquisitionOptions& options = {});

} // namespace graze

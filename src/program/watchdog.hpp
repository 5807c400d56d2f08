#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/record_folder.hpp"

#include <sys/types.h>

namespace graze {

/// A second process that survives when this one is killed. It then brings the generator to its safe amplitude and gives
/// finished records their names. It inherits the locks, so that no other process continues the experiment before.
class Watchdog {
public:
    /// Starts the process; to be done before connections are opened. @param experiment with the generator's line
    Watchdog(const Experiment& experiment, RecordFolder& folder);
    /// Ends the process.
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// From now on the generator may be in any state.
    void arm() const { tell('a'); }
    /// The generator is safe, or everything possible has been tried.
    void disarm() const { tell('d'); }

private:
    void tell(char word) const;
    int pipe_ = -1;
    pid_t process_ = -1;
};

} // namespace graze

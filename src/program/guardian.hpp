#pragma once

#include "graze/acquire/experiment.hpp"
#include "graze/acquire/record_folder.hpp"

#include <sys/types.h>

namespace graze {

/// A process that outlives this one when it is killed, and then brings the generator to its safe amplitude and the
/// records to their names. It keeps what was locked before, so that nobody goes on before it is done.
class Guardian {
public:
    /// To be made before connections are opened. @param experiment with the line that is to be opened then
    Guardian(const Experiment& experiment, RecordFolder& folder);
    /// Sends it home.
    ~Guardian();
    Guardian(const Guardian&) = delete;
    Guardian& operator=(const Guardian&) = delete;

    /// From now on the generator may be in any state.
    void arm() const { tell('a'); }
    /// It is safe, or all that could be done has been done.
    void disarm() const { tell('d'); }

private:
    void tell(char word) const;
    int pipe_ = -1;
    pid_t process_ = -1;
};

} // namespace graze

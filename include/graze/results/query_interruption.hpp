#pragma once

#include <functional>

namespace graze {

/// While it exists, queries of result files that run in this thread end when they are asked to, with an InputError, and
/// motions that are computed from them again (dense_motion) end where they are. An earlier one of the same thread
/// counts again afterwards.
class QueryInterruption {
public:
    /// @param interrupted called some thousand times a second while a query runs; returns true to stop it
    explicit QueryInterruption(std::function<bool()> interrupted);
    ~QueryInterruption();
    QueryInterruption(const QueryInterruption&) = delete;
    QueryInterruption& operator=(const QueryInterruption&) = delete;

    /// Whether queries of this thread have to stop.
    static bool requested();

private:
    std::function<bool()> interrupted_;
    const QueryInterruption* before_;
};

} // namespace graze

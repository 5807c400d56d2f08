#pragma once

#include "graze/design/design_report.hpp"
#include "graze/study/yield_part.hpp"
#include "python/attended.hpp"
#include "python/noted.hpp"

#include <functional>
#include <memory>
#include <string>

namespace graze::python {

/// What files that are written say of who has written them.
inline constexpr const char* writer = "graze " GRAZE_VERSION;

/// Computes a design, or what belongs to one, by `attended`.
/// @param told called with what is done at present; None: nothing is told
/// @param parts null: threads solve for the devices of yields
inline void attend_design(int threads, const py::object& told, const std::shared_ptr<PartExchange>& parts,
                          const std::function<void(const DesignReportOptions&)>& work) {
    Noted<std::string> what_is_done;
    attended(
        [&](const std::function<bool()>& must_stop) {
            DesignReportOptions options;
            options.jobs = threads;
            options.elsewhere = devices_by(parts);
            options.interrupted = must_stop;
            options.progress = [&](const std::string& what) { what_is_done.note(what); };
            work(options);
        },
        telling(told, [&] { return what_is_done.now(); }));
}

} // namespace graze::python

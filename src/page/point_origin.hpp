#pragma once

#include "graze/results/orbit_record.hpp"
#include "graze/results/stored_run.hpp"
#include "graze/study/study.hpp"

#include <cstddef>
#include <optional>
#include <string>

namespace graze {

/// Where a further run may begin: at a stored point of a run, or at the initial state of a model.
struct PointOrigin {
    std::string run{};                  ///< empty: the initial state of the model
    StudyRun asked{};                   ///< the run as it was asked for, of which `kind` and settings matter
    Model model{};                      ///< with the parameters of the point
    std::size_t number = 0;             ///< of the point
    std::optional<OrbitRecord> orbit{}; ///< of a run of orbits
    std::optional<PointRecord> point{}; ///< of a run of motions

    bool is_of(RunKind kind) const { return !run.empty() && asked.kind == kind; }
    PointType type() const { return orbit ? orbit->point.type : PointType::regular; }
    /// Its label, such as "GR1", or else its number.
    std::string name() const;
};

/// @throws InputError for an unknown run or point, and where the run cannot be read
PointOrigin point_origin(const StoredRun& stored, const Study& study, std::size_t number);
PointOrigin point_origin(const ResultFile& file, const Study& study, const std::string& run, std::size_t number);
/// The beginning of a model.
PointOrigin point_origin(const Model& model);

} // namespace graze

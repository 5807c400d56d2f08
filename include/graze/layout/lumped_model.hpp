#pragma once

#include "graze/layout/device_drawing.hpp"
#include "graze/model/model.hpp"
#include "graze/model/parameter_file.hpp"

#include <span>

namespace graze {

/// Lumped model of a drawn and etched device: the parameters of Eq. (6.1) for a point mass, in SI units.
struct LumpedModel {
    double mass = 0;      ///< kg, including the moving part of the flexures
    double stiffness = 0; ///< N/m, at the bridge of the H
    double damping = 0;   ///< N s/m
    double area = 0;      ///< m^2, of plates without fringe field and equal attraction (EquivalentPlates)
    double gap = 0;       ///< m, of these plates
    double stop = 0;      ///< m, to the contact, at the narrowest depth of the trench

    // Contributions to these.
    double plate_mass = 0;                                       ///< kg, of the H
    double stiff_trusses = 0;                                    ///< N/m, if only the beams bent
    double rigid_mass = 0;                                       ///< N/m, if the bars of the H did not bend
    double electrode_film = 0, stop_films = 0, chamber_film = 0; ///< N s/m
    double closure = 0;                                          ///< m, travel until the electrodes touch
    double stress_per_travel = 0;                                ///< Pa/m, largest stress of a beam per travel
    double squeeze = 0; ///< squeeze number of the film between the electrodes at the natural frequency

    double frequency() const; ///< undamped natural frequency, Hz
    double damping_ratio() const;
    /// Pull-in voltage in V, at which the electrodes snap together at rest, by Eq. (6.1): q = d/3, V^2 = 8 k d^3/(27
    /// epsilon A).
    double pull_in() const;
};

constexpr double vacuum_permittivity = 8.8541878128e-12; ///< F/m

/// Computes the lumped model from the drawn outlines: mass and trusses by their areas, gaps by the distances of
/// opposing edges, with walls that recede from the drawn edge by bias and taper (EtchedWall).
/// @param stop_departure deviation of the stops' gap from the drawn one, in um
/// @throws InputError when the etch removes a part completely
LumpedModel lumped_model_of(const DeviceDrawing& drawing, const ProcessData& process,
                            const ProcessConditions& conditions, double stop_departure = 0);
/// Does the same under the conditions of a design file. @throws InputError with the place of the process in the file
LumpedModel lumped_model_of(const DeviceDrawing& drawing, const DeviceFile& file);
LumpedModel lumped_model_of(const DeviceFile& file);

/// Returns the mean area that an etch leaves of a polygon between the surface and a depth, in um^2: edges recede,
/// corners stay sharp.
double etched_area(std::span<const GridPoint> corners, const EtchedWall& wall, double depth);

/// Loads the model that a design file names. @throws InputError with the file's place
Model model_of(const DeviceFile& file);

/// Returns the parameters m, f0, zeta, area, d and stop in the model's units, in full precision.
/// @throws InputError when the model lacks one, or its unit has another dimension
ParameterFile parameters_of(const LumpedModel& lumped, const Model& model);

} // namespace graze

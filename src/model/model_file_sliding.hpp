#pragma once

#include "model/model_file_drawing.hpp"

namespace graze {

/// Reads the tables [slides] and [friction] of a model.
class SlidingParts : protected DrawingParts {
protected:
    using DrawingParts::DrawingParts;

    /// Reads the names that rates may contain: of frictions, and of the controls of slides.
    void name_slides(const TomlEntry& group);
    void name_frictions(const TomlEntry& group);
    /// Read the contents. To be called when modes and events are known.
    void read_slides(const TomlEntry& group);
    void read_frictions(const TomlEntry& group);

private:
    void read_slide(const TomlEntry& entry, Slide& slide);
    void read_friction(const TomlEntry& entry, Friction& friction);
};

} // namespace graze

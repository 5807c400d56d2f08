#include "design/design_keys.hpp"

namespace graze {

void require_design_key(const TomlReader& reader, const TomlEntry& entry) {
    reader.require_known(entry, "",
                         {"name", "text", "source", "model", "control", "set", "approach", "trip", "points", "planes",
                          "dimensions", "yield", "adjustable", "wanted", "device", "process", "wafer", "rules"});
}

} // namespace graze

#include "model/unused_symbol.hpp"

namespace graze {

Expression unused_symbol(Model& model, const std::string& base) {
    std::string name = base;
    while (model.find_state(name) || model.find_parameter(name) || find_named(model.definitions, name))
        name += '_';
    return model.symbol(name);
}

} // namespace graze

#pragma once

#include "graze/model/model.hpp"

#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace graze {

class Abbreviations;

/// Expands expressions of one model in many calls, as Model::expand does in one. Each definition is expanded once, so
/// that the total time is proportional to the size of all expressions.
class Expander {
public:
    /// @param model its definitions must not change during the lifetime of this object; its graph grows
    explicit Expander(Model& model);
    ~Expander();
    Expander(const Expander&) = delete;
    Expander& operator=(const Expander&) = delete;

    Expression expand(const Expression& expression);
    /// @throws InputError when definitions refer to one another in a circle; the object cannot be used afterwards
    std::vector<Expression> expand(std::span<const Expression> expressions);

private:
    std::vector<Expression> replace(std::span<const Expression> wanted) const;

    Model& model_;
    std::unique_ptr<Abbreviations> abbreviations_;
    std::unordered_map<NodeIndex, Expression> values_; ///< of the abbreviations expanded so far
};

/// Returns the names of definitions or dependent parameters that form a circle, the first repeated at the
/// end; empty when there is no circle.
std::vector<std::string> find_circle(const Model& model);

/// Returns the text "a -> b -> a", shortened if long.
std::string circle_text(const std::vector<std::string>& names);

} // namespace graze

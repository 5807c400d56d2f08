#pragma once

#include "graze/model/model.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace graze {

class Abbreviations;

/// Expands expressions of one model in many calls, as Model::expand does in one. What definitions stand for is found
/// once, so that the time for all of them goes by their size.
class Expander {
public:
    /// @param model whose definitions must stay as they are for as long; its graph grows
    explicit Expander(Model& model);
    ~Expander();
    Expander(const Expander&) = delete;
    Expander& operator=(const Expander&) = delete;

    Expression expand(const Expression& expression);
    /// @throws InputError when definitions refer to one another in a circle; then it is of no more use
    std::vector<Expression> expand(std::span<const Expression> expressions);

private:
    std::vector<Expression> replace(std::span<const Expression> wanted) const;

    Model& model_;
    std::unique_ptr<Abbreviations> abbreviations_;
    std::unordered_map<NodeIndex, Expression> values_; ///< of those that have been expanded
};

/// Names of definitions or dependent parameters that refer to one another in a circle, the first repeated at the
/// end; empty when there is no circle.
std::vector<std::string> find_circle(const Model& model);

/// "a -> b -> a"
std::string circle_text(const std::vector<std::string>& names);

} // namespace graze

#include "model/model_expand.hpp"

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/transform.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <unordered_map>

namespace graze {

namespace {

/// A definition or dependent parameter, and what it needs of the others.
struct Abbreviation {
    Expression symbol, value;
    std::vector<std::size_t> needs;   ///< indices of abbreviations in `value`
    std::vector<std::size_t> used_by; ///< the inverse
};

/// All that stands for something else in a set of expressions, directly or not.
class Abbreviations {
public:
    Abbreviations(const Model& model, std::span<const Expression> expressions) {
        for (const Definition& definition : model.definitions)
            known_.emplace(model.symbol(definition.name).index(), definition.value);
        for (const Parameter& parameter : model.parameters)
            if (parameter.expression)
                known_.emplace(model.symbol(parameter.name).index(), *parameter.expression);
        require(expressions);
        for (std::size_t i = 0; i < list_.size(); ++i) { // the list grows while it is walked
            std::vector<std::size_t> needs = require({&list_[i].value, 1});
            for (const std::size_t need : needs)
                list_[need].used_by.push_back(i);
            list_[i].needs = std::move(needs);
        }
    }

    const std::vector<Abbreviation>& list() const { return list_; }

    /// Groups in which each abbreviation needs only those of earlier groups. Members of circles, and what needs
    /// them, are in none.
    std::vector<std::vector<std::size_t>> levels() const {
        std::vector<std::size_t> open(list_.size());
        std::vector<std::vector<std::size_t>> result(1);
        for (std::size_t i = 0; i < list_.size(); ++i) {
            open[i] = list_[i].needs.size();
            if (open[i] == 0)
                result.back().push_back(i);
        }
        while (!result.back().empty()) {
            std::vector<std::size_t> next;
            for (const std::size_t i : result.back())
                for (const std::size_t user : list_[i].used_by)
                    if (--open[user] == 0)
                        next.push_back(user);
            result.push_back(std::move(next));
        }
        result.pop_back();
        return result;
    }

    std::vector<std::string> circle() const {
        std::vector<bool> free(list_.size(), false);
        for (const auto& level : levels())
            for (const std::size_t i : level)
                free[i] = true;
        const auto start = std::find(free.begin(), free.end(), false);
        if (start == free.end())
            return {};
        // Each that is not free needs another one that is not: following them must come back somewhere.
        std::vector<std::size_t> path;
        std::vector<std::size_t> seen(list_.size(), list_.size());
        auto at = static_cast<std::size_t>(start - free.begin());
        while (seen[at] == list_.size()) {
            seen[at] = path.size();
            path.push_back(at);
            at = *std::find_if(list_[at].needs.begin(), list_[at].needs.end(), [&](std::size_t i) { return !free[i]; });
        }
        std::vector<std::string> names;
        for (std::size_t i = seen[at]; i < path.size(); ++i)
            names.push_back(list_[path[i]].symbol.name());
        names.push_back(list_[at].symbol.name());
        return names;
    }

private:
    /// Indices of the abbreviations in the expressions, which are added to the list when they are new.
    std::vector<std::size_t> require(std::span<const Expression> expressions) {
        std::vector<std::size_t> result;
        for (const Expression& symbol : symbols_of(expressions)) {
            const auto found = known_.find(symbol.index());
            if (found == known_.end())
                continue;
            const auto [place, is_new] = indices_.emplace(symbol.index(), list_.size());
            if (is_new)
                list_.push_back({symbol, found->second, {}, {}});
            result.push_back(place->second);
        }
        return result;
    }

    std::unordered_map<NodeIndex, Expression> known_;
    std::unordered_map<NodeIndex, std::size_t> indices_;
    std::vector<Abbreviation> list_;
};

} // namespace

std::string circle_text(const std::vector<std::string>& names) {
    return fmt::format("{}", fmt::join(names, " -> "));
}

std::vector<std::string> find_circle(const Model& model) {
    std::vector<Expression> all;
    for (const Definition& definition : model.definitions)
        all.push_back(model.symbol(definition.name));
    for (const Parameter& parameter : model.parameters)
        if (parameter.expression)
            all.push_back(model.symbol(parameter.name));
    return Abbreviations(model, all).circle();
}

Expression Model::expand(const Expression& expression) const {
    return expand(std::span<const Expression>(&expression, 1)).front();
}

std::vector<Expression> Model::expand(std::span<const Expression> expressions) const {
    const Abbreviations abbreviations(*this, expressions);
    const std::vector<Abbreviation>& list = abbreviations.list();
    std::vector<Expression> values(list.size());
    std::size_t done = 0;
    for (const auto& level : abbreviations.levels()) {
        std::vector<Expression> raw;
        std::vector<Replacement> replacements;
        std::vector<std::size_t> needed;
        for (const std::size_t i : level) {
            raw.push_back(list[i].value);
            needed.insert(needed.end(), list[i].needs.begin(), list[i].needs.end());
        }
        std::sort(needed.begin(), needed.end());
        needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
        for (const std::size_t i : needed)
            replacements.emplace_back(list[i].symbol, values[i]);
        const std::vector<Expression> expanded = substitute(raw, replacements);
        for (std::size_t k = 0; k < level.size(); ++k)
            values[level[k]] = expanded[k];
        done += level.size();
    }
    if (done < list.size())
        throw InputError({name, 0, 0},
                         "definitions refer to one another in a circle: " + circle_text(abbreviations.circle()),
                         "define one of them without the others");
    std::vector<Replacement> replacements;
    for (std::size_t i = 0; i < list.size(); ++i)
        replacements.emplace_back(list[i].symbol, values[i]);
    return substitute(expressions, replacements);
}

std::vector<double> evaluate_in_parameters(const Model& model, std::span<const Expression> expressions) {
    const Function function(model.parameter_symbols(), model.expand(expressions));
    return function(model.parameter_values());
}

} // namespace graze

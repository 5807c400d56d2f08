#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace graze {

/// Several mistakes of one text. When caught as an InputError it stands for the first of them.
class InputErrors : public InputError {
public:
    /// @param all two or more
    explicit InputErrors(std::vector<InputError> all) : InputError(all.front()), all_(std::move(all)) {}

    /// All mistakes, ordered by their places.
    const std::vector<InputError>& all() const { return all_; }

private:
    std::vector<InputError> all_;
};

/// Collects mistakes while reading goes on, so that the user sees all of them at once.
class Mistakes {
public:
    /// Reading stops at this many mistakes: each may cost a search for similar names.
    static constexpr std::size_t most = 100;

    /// Runs `work` and notes the InputError or InputErrors that it throws. @return true when it threw neither
    /// @throws InputErrors once `most` mistakes have been noted
    template <class Work>
    bool attempt(const Work& work) {
        try {
            work();
            return true;
        } catch (const InputErrors& errors) {
            for (const InputError& error : errors.all())
                note(error);
        } catch (const InputError& error) {
            note(error);
        }
        if (all_.size() >= most)
            throw_noted();
        return false;
    }
    bool none() const { return all_.empty(); }
    /// Throws the noted mistakes, grouped by file and ordered by place; returns when there are none.
    /// @throws InputError for a single mistake, InputErrors for several
    void throw_noted();

private:
    /// Adds a mistake unless it is already there: several readers may meet the same one.
    void note(const InputError& error);

    std::vector<InputError> all_;
};

} // namespace graze

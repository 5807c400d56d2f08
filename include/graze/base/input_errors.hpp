#pragma once

#include "graze/base/input_error.hpp"

#include <cstddef>
#include <vector>

namespace graze {

/// Several mistakes of one text. As an InputError it is the first of them.
class InputErrors : public InputError {
public:
    /// @param all two or more
    explicit InputErrors(std::vector<InputError> all) : InputError(all.front()), all_(std::move(all)) {}

    /// In the order of their places.
    const std::vector<InputError>& all() const { return all_; }

private:
    std::vector<InputError> all_;
};

/// Mistakes that are noted while reading goes on, for all of them to be told at once.
class Mistakes {
public:
    /// So many are enough: each may cost a search for names that are alike.
    static constexpr std::size_t most = 100;

    /// Does something, and notes the mistake that it finds. @return whether it found none
    /// @throws InputErrors when there are as many as are wanted
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
    /// In the order of their places, those of one file after those of another.
    /// @throws InputError for the one that has been noted, or InputErrors; returns when there is none
    void throw_noted();

private:
    /// Unless the same has been noted: several readers may meet one mistake.
    void note(const InputError& error);

    std::vector<InputError> all_;
};

} // namespace graze

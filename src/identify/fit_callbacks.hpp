#pragma once

#include "graze/identify/fit.hpp"

#include <exception>

namespace graze {

/// Callbacks of which the first that throws interrupts the fit, so that the solver is left in order.
class FitCallbacks {
public:
    explicit FitCallbacks(const FitSettings& settings) : given_(&settings), settings_(settings) {
        if (settings.interrupted)
            settings_.interrupted = [this] { return ends([this] { return given_->interrupted(); }); };
        if (settings.progress)
            settings_.progress = [this](const FitProgress& progress) {
                return !ends([&] { return !given_->progress(progress); });
            };
    }
    FitCallbacks(const FitCallbacks&) = delete;
    FitCallbacks& operator=(const FitCallbacks&) = delete;
    const FitSettings& settings() const { return settings_; }
    void rethrow() const {
        if (thrown_)
            std::rethrow_exception(thrown_);
    }

private:
    template <class Question>
    bool ends(const Question& question) {
        try {
            return thrown_ || question();
        } catch (...) {
            thrown_ = std::current_exception();
            return true;
        }
    }

    const FitSettings* given_;
    FitSettings settings_;
    std::exception_ptr thrown_;
};

} // namespace graze

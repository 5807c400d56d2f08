#pragma once

#include "graze/base/input_error.hpp"

#include <hdf5.h>

#include <string>
#include <utility>

namespace graze {

/// Owns an identifier of the HDF5 library, and closes it.
class Hdf5Handle {
public:
    Hdf5Handle() = default;
    /// @throws FileError with this problem and remedy when the identifier is invalid
    Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& path, const std::string& problem,
               const std::string& remedy)
        : id_(id), close_(close) {
        if (id < 0)
            throw FileError(path, problem, remedy);
    }
    ~Hdf5Handle() {
        if (id_ >= 0)
            close_(id_);
    }
    Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    Hdf5Handle(const Hdf5Handle&) = delete;
    Hdf5Handle& operator=(const Hdf5Handle&) = delete;
    hid_t id() const { return id_; }

private:
    hid_t id_ = -1;
    herr_t (*close_)(hid_t) = nullptr;
};

} // namespace graze

#pragma once

#include "graze/base/item_range.hpp"
#include "study/point_bytes.hpp"

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>

namespace graze {

/// What process 0 and those that compute for it tell each other.
struct DealtMessage {
    enum class What : unsigned char {
        work,   ///< to compute parts of: `bytes` is its text
        task,   ///< a part of work: `bytes` is what the worker is given
        forget, ///< work of which nothing more is wanted
        end,    ///< nothing more comes
        piece,  ///< of the result of a task
        result, ///< of a task, or the rest of it; it has taken `seconds`
        failed, ///< a task: `bytes` is the error
        left,   ///< a task of work that is not wanted any more
        bye,    ///< nothing more comes
    };
    What what = What::end;
    std::size_t work = 0;
    ItemRange items{};
    double seconds = 0;
    std::string bytes{};
};

std::string bytes_of(const DealtMessage& message);
/// @throws InputError when the bytes are none of `bytes_of`
DealtMessage message_of(std::string_view bytes);

/// An error as bytes, to be thrown by another process.
std::string bytes_of(const std::exception_ptr& error);
std::exception_ptr error_of(std::string_view bytes);

} // namespace graze

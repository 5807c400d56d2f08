#include "study/dealt_messages.hpp"

#include <new>
#include <stdexcept>

namespace graze {

namespace {

enum class ErrorType { input, memory, other };

template <class Bytes, class Message>
void describe(Bytes& bytes, Message& message) {
    bytes.choice(message.what, DealtMessage::What::bye);
    bytes(message.work, message.items.first, message.items.last, message.seconds, message.bytes);
}

std::string bytes_of(ErrorType type, const Place& place, const std::string& problem, const std::string& remedy) {
    ByteWriter bytes;
    bytes.choice(type, ErrorType::other);
    bytes(place.file, place.line, place.column, problem, remedy);
    return bytes.take();
}

} // namespace

std::string bytes_of(const DealtMessage& message) {
    ByteWriter bytes;
    describe(bytes, message);
    return bytes.take();
}

DealtMessage message_of(std::string_view bytes) {
    ByteReader reader(bytes);
    DealtMessage message;
    describe(reader, message);
    reader.require_end();
    return message;
}

std::string bytes_of(const std::exception_ptr& error) {
    try {
        std::rethrow_exception(error);
    } catch (const InputError& input) {
        return bytes_of(ErrorType::input, input.place(), input.problem(), input.remedy());
    } catch (const std::bad_alloc&) {
        return bytes_of(ErrorType::memory, {}, "", "");
    } catch (const std::exception& other) {
        return bytes_of(ErrorType::other, {}, other.what(), "");
    }
}

std::exception_ptr error_of(std::string_view bytes) {
    ByteReader reader(bytes);
    ErrorType type{};
    Place place;
    std::string problem, remedy;
    reader.choice(type, ErrorType::other);
    reader(place.file, place.line, place.column, problem, remedy);
    switch (type) {
    case ErrorType::input:
        return std::make_exception_ptr(InputError(place, problem, remedy));
    case ErrorType::memory:
        return std::make_exception_ptr(std::bad_alloc());
    case ErrorType::other:
        break;
    }
    return std::make_exception_ptr(std::runtime_error(problem));
}

} // namespace graze

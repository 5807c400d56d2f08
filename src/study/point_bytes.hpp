#pragma once

#include "graze/base/input_error.hpp"

#include <bit>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace graze {

static_assert(std::endian::native == std::endian::little, "bytes are exchanged in this order");

/// Writes values one after another as bytes, every bit of them.
class ByteWriter {
public:
    /// @param mark the first bytes, by which a reader knows what follows
    explicit ByteWriter(const std::string& mark = {}) : bytes_(mark) {}

    template <class... Values>
    void operator()(const Values&... values) {
        (write(values), ...);
    }
    template <class Choice>
    void choice(Choice value, Choice) {
        write(static_cast<std::uint64_t>(value));
    }
    /// @param describe is called with this and each item
    template <class Item, class Describe>
    void list(const std::vector<Item>& items, Describe describe) {
        write(std::uint64_t{items.size()});
        for (const Item& item : items)
            describe(*this, item);
    }
    std::string take() { return std::move(bytes_); }

private:
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void write(Number value) {
        char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        bytes_.append(bytes, sizeof value);
    }
    void write(const std::complex<double>& value) { (*this)(value.real(), value.imag()); }
    void write(const std::string& text) {
        write(std::uint64_t{text.size()});
        bytes_ += text;
    }
    template <class Value>
    void write(const std::optional<Value>& value) {
        write(value.has_value());
        if (value)
            write(*value);
    }
    template <class Item>
    void write(const std::vector<Item>& items) {
        write(std::uint64_t{items.size()});
        for (const Item& item : items)
            write(item);
    }
    std::string bytes_;
};

/// Reads what ByteWriter has written. @throws InputError, from each function, where that is impossible
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes, std::string_view mark = {}) : left_(bytes) {
        if (!bytes.starts_with(mark))
            fail();
        left_.remove_prefix(mark.size());
    }

    template <class... Values>
    void operator()(Values&... values) {
        (read(values), ...);
    }
    /// An enumerator that is `last` at most.
    template <class Choice>
    void choice(Choice& value, Choice last) {
        std::uint64_t index = 0;
        read(index);
        if (index > static_cast<std::uint64_t>(last))
            fail();
        value = static_cast<Choice>(index);
    }
    template <class Item, class Describe>
    void list(std::vector<Item>& items, Describe describe) {
        items.resize(read_size(1));
        for (Item& item : items)
            describe(*this, item);
    }
    bool is_at_end() const { return left_.empty(); }
    void require_end() const {
        if (!is_at_end())
            fail();
    }
    [[noreturn]] static void fail() {
        throw InputError("these bytes are no part of a computation", "let it be computed again");
    }

private:
    std::string_view next(std::uint64_t size) {
        if (size > left_.size())
            fail();
        const std::string_view bytes = left_.substr(0, size);
        left_.remove_prefix(size);
        return bytes;
    }
    /// The number of items, each of which takes `least` bytes at least.
    std::uint64_t read_size(std::size_t least) {
        std::uint64_t size = 0;
        read(size);
        if (size > left_.size() / least)
            fail();
        return size;
    }
    template <class Number>
    requires std::is_arithmetic_v<Number>
    void read(Number& value) { std::memcpy(&value, next(sizeof value).data(), sizeof value); }
    void read(bool& value) {
        unsigned char byte = 0;
        read(byte);
        if (byte > 1)
            fail();
        value = byte == 1;
    }
    void read(std::complex<double>& value) {
        double real = 0, imaginary = 0;
        (*this)(real, imaginary);
        value = {real, imaginary};
    }
    void read(std::string& text) {
        std::uint64_t size = 0;
        read(size);
        text = next(size);
    }
    template <class Value>
    void read(std::optional<Value>& value) {
        bool is_there = false;
        read(is_there);
        value.reset();
        if (is_there)
            read(value.emplace());
    }
    template <class Item>
    void read(std::vector<Item>& items) {
        constexpr bool is_number = std::is_arithmetic_v<Item> || std::is_same_v<Item, std::complex<double>>;
        items.resize(read_size(is_number ? sizeof(Item) : 1));
        for (Item& item : items)
            read(item);
    }
    std::string_view left_;
};

} // namespace graze

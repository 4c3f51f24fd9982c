// Values as bytes, and back. Structs say what they hold by a function `fields`, which serves both ways.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace dermis {

/// Values whose bytes hold nothing else: numbers, enumerations and arrays of them.
template <class Value>
struct IsPlain : std::bool_constant<std::is_arithmetic_v<Value> || std::is_enum_v<Value>> {};
template <class Element, std::size_t count>
struct IsPlain<std::array<Element, count>> : IsPlain<Element> {};

/// Values one after the other. Files of it are read by the machine that has written them, or by one like it.
class Packed {
 public:
  template <class... Values>
  void operator()(const Values&... values) {
    (add(values), ...);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  template <class Value>
  void add(const Value& value) {
    if constexpr (IsPlain<Value>::value) {
      append(&value, sizeof(Value));
    } else {
      fields(*this, value);
    }
  }

  template <class Element>
  void add(const std::vector<Element>& elements) {
    add(static_cast<std::uint64_t>(elements.size()));
    if constexpr (IsPlain<Element>::value) {
      append(elements.data(), elements.size() * sizeof(Element));
    } else {
      for (const Element& element : elements) add(element);
    }
  }

  template <class Element, std::size_t count>
  void add(const std::array<Element, count>& elements) {
    if constexpr (IsPlain<Element>::value) {
      append(elements.data(), sizeof(elements));
    } else {
      for (const Element& element : elements) add(element);
    }
  }

  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    append(text.data(), text.size());
  }

  void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }

  std::string bytes_;
};

/// Takes values out of bytes in the order in which they were put in. Bytes that are short or say nonsense leave values
/// as they are, and are not `complete`; none of them makes it read or allocate more than there is.
class Unpacked {
 public:
  explicit Unpacked(std::string_view bytes) : left_(bytes) {}

  template <class... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }

  /// Whether all values were there, and nothing else.
  bool complete() const { return is_sound_ && left_.empty(); }

 private:
  template <class Value>
  void take(Value& value) {
    if constexpr (std::is_same_v<Value, bool>) {
      std::uint8_t byte = 0;
      take(byte);
      is_sound_ = is_sound_ && byte <= 1;
      value = byte == 1;
    } else if constexpr (IsPlain<Value>::value) {
      static_assert(!std::is_enum_v<Value>, "bytes may hold what is no enumerator");
      copy(&value, sizeof(Value));
    } else {
      fields(*this, value);
    }
  }

  template <class Element>
  void take(std::vector<Element>& elements) {
    std::uint64_t size = 0;
    take(size);
    constexpr std::size_t least_bytes = IsPlain<Element>::value ? sizeof(Element) : 1;
    if (size > left_.size() / least_bytes) is_sound_ = false;
    if (!is_sound_) return;
    elements.clear();
    if constexpr (IsPlain<Element>::value) {
      elements.resize(size);
      copy(elements.data(), size * sizeof(Element));
    } else {
      for (std::uint64_t i = 0; i < size && is_sound_; ++i) take(elements.emplace_back());
    }
  }

  void take(std::string& text) {
    std::uint64_t size = 0;
    take(size);
    is_sound_ = is_sound_ && size <= left_.size();
    if (!is_sound_) return;
    text.resize(size);
    copy(text.data(), size);
  }

  template <class Element, std::size_t count>
  void take(std::array<Element, count>& elements) {
    if constexpr (IsPlain<Element>::value) {
      static_assert(!std::is_same_v<Element, bool>);
      copy(elements.data(), sizeof(elements));
    } else {
      for (Element& element : elements) take(element);
    }
  }

  void copy(void* to, std::size_t size) {
    is_sound_ = is_sound_ && size <= left_.size();
    if (!is_sound_ || size == 0) return;
    std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }

  std::string_view left_;
  bool is_sound_ = true;
};

}  // namespace dermis

// Values that are slow to make, kept for the next who asks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace dermis {

/// Values by key, those that were asked for last. For several threads; values are handed out as copies.
template <class Key, class Value>
class Recent {
 public:
  /// Keeps values whose sizes sum to at most `most`.
  Recent(std::size_t most, std::function<std::size_t(const Value&)> size) : most_(most), size_(std::move(size)) {}

  /// The value of an equal key, else what make() returns. Threads that ask for a key while it is made wait for it, and
  /// get the same value or exception; after an exception the next to ask makes it again.
  template <class Make>
  Value get(const Key& key, const Make& make) {
    std::promise<Value> promise;
    const auto [entry, is_new] = find_or_add(key, promise);
    if (!is_new) return entry->value.get();
    try {
      Value value = make();
      keep(entry, size_(value));
      promise.set_value(std::move(value));
    } catch (...) {
      drop(entry);
      promise.set_exception(std::current_exception());
    }
    return entry->value.get();
  }

  /// The keys of the values that are kept or being made.
  std::vector<Key> keys() {
    const std::lock_guard lock(mutex_);
    std::vector<Key> result;
    for (const Shared& entry : entries_) result.push_back(entry->key);
    return result;
  }

 private:
  struct Entry {
    Key key;
    std::shared_future<Value> value;
    std::size_t size = 0;  ///< 0 until it is made
  };
  using Shared = std::shared_ptr<Entry>;

  std::pair<Shared, bool> find_or_add(const Key& key, std::promise<Value>& promise) {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Shared& e) { return e->key == key; });
    const bool is_new = found == entries_.end();
    if (is_new) {
      entries_.push_front(std::make_shared<Entry>(Entry{key, promise.get_future().share()}));
    } else {
      entries_.splice(entries_.begin(), entries_, found);
    }
    return {entries_.front(), is_new};
  }

  void keep(const Shared& entry, std::size_t size) {
    const std::lock_guard lock(mutex_);
    entry->size = size;
    std::size_t sum = 0;
    entries_.remove_if([&](const Shared& e) { return (sum += e->size) > most_; });
  }

  void drop(const Shared& entry) {
    const std::lock_guard lock(mutex_);
    entries_.remove(entry);
  }

  std::mutex mutex_;
  std::list<Shared> entries_;  ///< the latest first
  std::size_t most_;
  std::function<std::size_t(const Value&)> size_;
};

}  // namespace dermis

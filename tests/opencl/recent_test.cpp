// Values that are made once and shared.
#include "opencl/recent.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/catch.hpp"

using dermis::Recent;

namespace {

using Texts = Recent<int, std::string>;

std::size_t length(const std::string& text) { return text.size(); }

/// Makes texts of a length, and counts them.
struct Maker {
  Texts& texts;
  int made = 0;

  std::string get(int key, std::size_t size) {
    return texts.get(key, [&] {
      ++made;
      return std::string(size, static_cast<char>('a' + key));
    });
  }
};

}  // namespace

TEST_CASE("a value is made once per key", "[recent]") {
  Texts texts(100, length);
  Maker maker{texts};
  CHECK(maker.get(0, 3) == "aaa");
  CHECK(maker.get(1, 3) == "bbb");
  CHECK(maker.get(0, 5) == "aaa");
  CHECK(maker.made == 2);
}

TEST_CASE("the values that were asked for last are kept, up to a size", "[recent]") {
  Texts texts(10, length);
  Maker maker{texts};
  maker.get(0, 4);
  maker.get(1, 4);
  maker.get(0, 4);  // It is later than 1 now.
  maker.get(2, 4);  // There are 12 in all, so that 1 goes.
  CHECK(maker.made == 3);
  maker.get(0, 4);
  maker.get(2, 4);
  CHECK(maker.made == 3);
  maker.get(1, 4);
  CHECK(maker.made == 4);
  maker.get(3, 11);  // It is more than there is room for.
  maker.get(3, 11);
  CHECK(maker.made == 6);
}

TEST_CASE("a value that could not be made is made again", "[recent]") {
  Texts texts(10, length);
  CHECK_THROWS_WITH(texts.get(0, []() -> std::string { throw std::runtime_error("no"); }), "no");
  CHECK(Maker{texts}.get(0, 1) == "a");
}

TEST_CASE("threads that ask for the same share one call", "[recent]") {
  Texts texts(1000, length);
  std::atomic<int> made = 0;
  std::atomic<int> right = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      for (int key = 0; key < 50; ++key) {
        const std::string text = texts.get(key, [&] {
          ++made;
          std::this_thread::yield();
          return std::to_string(key);
        });
        if (text == std::to_string(key)) ++right;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(right == 8 * 50);
  CHECK(made == 50);
}

// Taps that are kept on disk: they are those that are fitted, and nothing that lies in the folder can change that.
#include "taps/kept/kept_taps.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "dermis/plan.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/some_profiles.hpp"
#include "support/temporary_folder.hpp"
#include "taps/kept/kept_files.hpp"
#include "taps/kept/packed.hpp"

using dermis::DesignChoice;
using dermis::kept_choice;
using dermis::kept_taps;
using dermis::kept_with_rank;
using dermis::KeptFiles;
using dermis::make_taps;
using dermis::Packed;
using dermis::Profile;
using dermis::TapLevel;
using dermis::Taps;
using dermis::TapsDesign;

namespace fs = std::filesystem;

namespace {

/// All bits of the taps.
std::string bits_of(const Taps& taps) {
  Packed bits;
  bits(taps.radius_mm, taps.relative_width);
  for (const dermis::Term& term : taps.terms) bits(term.scale, term.normalised, term.sum);
  for (const TapLevel& level : taps.levels) {
    bits(level.px_per_mm, level.offsets_px, level.weights, level.flat_weights);
    for (const dermis::Nearness& its : level.nearness) bits(its.scale, its.softening, its.end);
  }
  return bits.bytes();
}

std::vector<fs::path> files_in(const std::string& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  return files;
}

fs::path only_file_in(const std::string& folder) {
  const std::vector<fs::path> files = files_in(folder);
  REQUIRE(files.size() == 1);
  return files.front();
}

/// Puts a file in place of another, with the checksum that it has to have. The header is 8 bytes of magic, the size of
/// the key and the checksum of what follows.
void write_with_checksum(const fs::path& path, std::string bytes) {
  std::uint64_t key_bytes = 0;
  std::memcpy(&key_bytes, &bytes[8], sizeof(key_bytes));
  const std::uint64_t sum = dermis::checksum(std::string_view(bytes).substr(24), key_bytes);
  std::memcpy(&bytes[16], &sum, sizeof(sum));
  write_bytes(path.string(), bytes);
  chmod(path.c_str(), 0600);
}

std::size_t content_begin(const std::string& bytes) {
  std::uint64_t key_bytes = 0;
  std::memcpy(&key_bytes, &bytes[8], sizeof(key_bytes));
  return 24 + key_bytes;
}

/// Quick to fit, and with all that a table can have.
const TapsDesign plain{.model = dermis::Model::svd, .rank = 2, .count = 7, .placement = dermis::Placement::importance};

/// A folder that keeps the taps of one profile, whose radius somebody has doubled there: what is read is seen.
struct Poisoned {
  TemporaryFolder folder;
  std::string name = folder / "kept";
  Profile profile = Profile::burley({1, 0.5, 0.25});
  Taps fitted = make_taps(profile, plain);
  fs::path file;

  Poisoned() {
    kept_taps(name, profile, plain);
    file = only_file_in(name);
    std::string bytes = bytes_of_file(file.string());
    const double radius_mm = 2 * fitted.radius_mm;
    std::memcpy(&bytes[content_begin(bytes)], &radius_mm, sizeof(radius_mm));
    write_with_checksum(file, bytes);
  }

  bool is_read() const { return bits_of(kept_taps(name, profile, plain)) != bits_of(fitted); }
};

}  // namespace

TEST_CASE("kept taps are those that are fitted, to the bit", "[kept]") {
  const TemporaryFolder folder;
  const std::string name = folder / "a/b";
  Random random(4101);
  const auto profiles = profiles_of_every_kind(4102);
  for (const auto& [kind, profile, breaks] : profiles) {
    INFO(kind);
    const TapsDesign design{.rank = random.integer(1, 3), .count = 5, .widest_px = 64};
    const std::string fitted = bits_of(make_taps(profile, design));
    CHECK(bits_of(kept_taps(name, profile, design)) == fitted);
    CHECK(bits_of(kept_taps(name, profile, design)) == fitted);
  }
  CHECK(files_in(name).size() == profiles.size());  // none took the place of another
}

TEST_CASE("kept choices are those that are made", "[kept]") {
  const TemporaryFolder folder;
  const std::string name = folder / "kept";
  const Profile profile = dermis::preset("skin").profile;
  const TapsDesign wanted = dermis::design_within(0.02);
  const DesignChoice made = dermis::choose_design(profile, wanted, 0.3);
  const TapsDesign ranked = with_rank(profile, wanted);
  for (int i = 0; i < 2; ++i) {
    const DesignChoice kept = kept_choice(name, profile, wanted, 0.3);
    CHECK(kept.design == made.design);
    CHECK(kept.predicted_rel_l2 == made.predicted_rel_l2);
    CHECK(kept_with_rank(name, profile, wanted) == ranked);
    CHECK(files_in(name).size() == 2);
  }
  // Whatever the result depends on has a file of its own.
  kept_choice(name, profile, wanted, 0.4);
  kept_choice(name, profile, dermis::design_within(0.03), 0.3);
  kept_choice(name, dermis::preset("wax").profile, wanted, 0.3);
  CHECK(files_in(name).size() == 5);
}

TEST_CASE("kept taps are read from files, of this user alone", "[kept]") {
  const Poisoned poisoned;
  REQUIRE(poisoned.is_read());
  struct stat its {};
  REQUIRE(stat(poisoned.name.c_str(), &its) == 0);
  CHECK((its.st_mode & 0777) == 0700);
  SECTION("a file that others may write") {
    chmod(poisoned.file.c_str(), 0666);
    CHECK_FALSE(poisoned.is_read());
  }
  SECTION("a folder that others may write") {
    chmod(poisoned.name.c_str(), 0777);
    CHECK_FALSE(poisoned.is_read());
    CHECK_FALSE(dermis::can_keep_taps(poisoned.name));
  }
  SECTION("a link") {
    fs::rename(poisoned.file, poisoned.folder / "elsewhere");
    fs::create_symlink(poisoned.folder / "elsewhere", poisoned.file);
    CHECK_FALSE(poisoned.is_read());
    CHECK(fs::is_regular_file(fs::symlink_status(poisoned.file)));  // the link has gone, and not what it led to
    CHECK(fs::exists(poisoned.folder / "elsewhere"));
  }
  SECTION("a pipe, which would never open") {
    fs::remove(poisoned.file);
    REQUIRE(mkfifo(poisoned.file.c_str(), 0600) == 0);
    CHECK_FALSE(poisoned.is_read());
  }
  if (geteuid() == 0) {  // nobody else can give files away
    SECTION("a file of somebody else") {
      REQUIRE(chown(poisoned.file.c_str(), 1, 1) == 0);
      CHECK_FALSE(poisoned.is_read());
    }
    SECTION("a folder of somebody else") {
      REQUIRE(chown(poisoned.name.c_str(), 1, 1) == 0);
      CHECK_FALSE(poisoned.is_read());
    }
  }
}

TEST_CASE("kept taps that are damaged are fitted again", "[kept]") {
  Random random(4103);
  const Poisoned poisoned;
  const std::string whole = bytes_of_file(poisoned.file.string());
  const auto size = static_cast<int>(whole.size());
  const auto is_fitted_again = [&](const std::string& damaged) {
    write_bytes(poisoned.file.string(), damaged);
    chmod(poisoned.file.c_str(), 0600);
    const bool is_unread = !poisoned.is_read();
    return is_unread && bytes_of_file(poisoned.file.string()).size() == whole.size();
  };
  for (int i = 0; i < 8; ++i) {
    std::string damaged = whole;
    // The first ones are in the header and in the key.
    const int at = i < 2 ? random.integer(0, 23) : i < 4 ? random.integer(24, 200) : random.integer(0, size - 1);
    damaged[static_cast<std::size_t>(at)] ^= static_cast<char>(1 << random.integer(0, 7));
    INFO("byte " << at);
    CHECK(is_fitted_again(damaged));
    const int length = random.integer(0, size - 1);
    INFO("length " << length);
    CHECK(is_fitted_again(whole.substr(0, static_cast<std::size_t>(length))));
  }
  CHECK(is_fitted_again(""));
  CHECK(is_fitted_again(whole + '\0'));
  CHECK(is_fitted_again(std::string(KeptFiles::most_bytes_of_file + 1, 'x')));
}

TEST_CASE("kept taps whose checksum is right, but which say nonsense, are fitted again", "[kept]") {
  Random random(4104);
  const Poisoned poisoned;
  const std::string whole = bytes_of_file(poisoned.file.string());
  const std::size_t begin = content_begin(whole);
  const auto is_fitted_again = [&](const auto& value, std::size_t at) {
    std::string damaged = whole;
    std::memcpy(&damaged[at], &value, sizeof(value));
    write_with_checksum(poisoned.file, damaged);
    return !poisoned.is_read();
  };
  // The radius, three widths, then the number of terms.
  CHECK(is_fitted_again(std::numeric_limits<double>::quiet_NaN(), begin));
  CHECK(is_fitted_again(-1.0, begin));
  for (const std::uint64_t terms : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{3}, std::uint64_t{1} << 62,
                                    std::numeric_limits<std::uint64_t>::max()}) {
    CHECK(is_fitted_again(terms, begin + 8 + 12));
  }
  CHECK(is_fitted_again('\2', begin + 8 + 12 + 8 + 12));  // whether the first term is normalised
  write_with_checksum(poisoned.file, whole + '\0');
  CHECK_FALSE(poisoned.is_read());
  // Anything anywhere: nothing crashes, reads beyond the end, or asks for more memory than there is.
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole;
    for (int j = random.integer(1, 8); j > 0; --j) {
      const int at = random.integer(static_cast<int>(begin), static_cast<int>(whole.size()) - 1);
      damaged[static_cast<std::size_t>(at)] = static_cast<char>(random.integer(0, 255));
    }
    if (random.coin())
      damaged.resize(static_cast<std::size_t>(random.integer(static_cast<int>(begin), static_cast<int>(whole.size()))));
    write_with_checksum(poisoned.file, damaged);
    const Taps taps = kept_taps(poisoned.name, poisoned.profile, plain);
    REQUIRE(taps.terms.size() == 2);
    REQUIRE(taps.levels.size() == poisoned.fitted.levels.size());
  }
}

TEST_CASE("taps are kept nowhere without a folder", "[kept]") {
  const TemporaryFolder folder;
  write_bytes(folder / "file", "of somebody");
  const Profile profile = Profile::burley({1, 0.5, 0.25});
  const std::string fitted = bits_of(make_taps(profile, plain));
  for (const std::string& name : {std::string(), folder / "file", folder / "file/below", std::string("/proc/none")}) {
    INFO(name);
    CHECK_FALSE(dermis::can_keep_taps(name));
    CHECK(bits_of(kept_taps(name, profile, plain)) == fitted);
  }
  CHECK(folder.file_count() == 1);
  CHECK(bytes_of_file(folder / "file") == "of somebody");
}

TEST_CASE("a full disk leaves no half of a file", "[kept]") {
  const TemporaryFolder folder;
  const KeptFiles files(folder / "kept");
  REQUIRE(files.is_usable());
  struct rlimit before {};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit low = before;
  low.rlim_cur = 10000;  // a write beyond that fails as one on a full disk does
  REQUIRE(setrlimit(RLIMIT_FSIZE, &low) == 0);
  files.put("long", std::string(20000, 'x'));
  files.put("short", "x");
  REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
  std::signal(SIGXFSZ, handler);
  CHECK(files_in(folder / "kept").size() == 1);
  CHECK(files.get("long") == std::nullopt);
  CHECK(files.get("short") == "x");
}

TEST_CASE("kept files of several writers are whole", "[kept]") {
  const TemporaryFolder folder;
  const auto content = [](int i) {
    return std::string(static_cast<std::size_t>(1000 + 50 * i), static_cast<char>('a' + i));
  };
  const auto write_and_read = [&](int writer) {
    const KeptFiles files(folder / "kept");
    bool is_whole = true;
    for (int i = 0; i < 100; ++i) {
      files.put("key", content(writer));
      const auto its = files.get("key");
      is_whole = is_whole && its && !its->empty() && *its == content(its->front() - 'a');
    }
    return is_whole;
  };
  std::array<bool, 4> are_whole{};
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&, i] { are_whole[static_cast<std::size_t>(i)] = write_and_read(i); });
  }
  CHECK(are_whole == std::array{true, true, true, true});
  CHECK(files_in(folder / "kept").size() == 1);
}

TEST_CASE("kept files take no more room than is theirs, and the longest unused go", "[kept]") {
  const TemporaryFolder folder;
  const std::string name = folder / "kept";
  const KeptFiles files(name);
  write_bytes(name + "/notes", std::string(100, 'n'));
  const std::string content(std::size_t{7} << 20, 'x');
  // The one that is read is the older one.
  const auto now = fs::file_time_type::clock::now();
  files.put("used", content);
  for (const fs::path& file : files_in(name)) fs::last_write_time(file, now - std::chrono::hours(2));
  files.put("unused", content);
  for (const fs::path& file : files_in(name)) {
    if (fs::last_write_time(file) > now - std::chrono::minutes(1))
      fs::last_write_time(file, now - std::chrono::hours(1));
  }
  REQUIRE(files.get("used").has_value());
  for (int i = 0; i < 8; ++i) files.put("other " + std::to_string(i), content);
  std::uintmax_t sum = 0;
  for (const fs::path& file : files_in(name)) sum += fs::file_size(file);
  CHECK(sum <= KeptFiles::most_bytes + 100);
  CHECK(files_in(name).size() == 1 + 9);
  CHECK(files.get("used").has_value());
  CHECK(files.get("unused") == std::nullopt);
  CHECK(bytes_of_file(name + "/notes").size() == 100);
  // What is larger than a file may be is not kept.
  files.put("huge", std::string(KeptFiles::most_bytes_of_file, 'x'));
  CHECK(files.get("huge") == std::nullopt);
}

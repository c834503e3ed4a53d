#include "machine/base/confinement.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "machine/base/diagnostic.h"

using namespace kadr;

namespace {

namespace fs = std::filesystem;

/// A folder `in`, and `out` beside it; removed at the end.
struct TwoFolders {
  fs::path path =
      fs::canonical(fs::temp_directory_path()) / ("kadr_confinement_" + std::to_string(::getpid()));
  TwoFolders() {
    fs::remove_all(path);
    fs::create_directories(path / "in/sub");
    fs::create_directories(path / "out");
    write("in/a", "inside");
    write("out/a", "outside");
    fs::create_symlink("../out", path / "in/link");
    fs::create_symlink("a", path / "in/same");
    fs::create_symlink("nowhere", path / "in/dangling");
  }
  ~TwoFolders() { fs::remove_all(path); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
  InputFile file(const std::string& name, std::vector<std::string> allowed = {}) const {
    return {name, InputFolders{(path / "in").string(), std::move(allowed)}};
  }
};

/// Opens and closes.
bool opens(const fs::path& path) {
  const int fd = open_without_links(path.string());
  if (fd >= 0) ::close(fd);
  return fd >= 0;
}

}  // namespace

TEST_CASE("where a named file lies is decided behind all links") {
  const TwoFolders folders;
  const std::string out = (folders.path / "out").string();
  const auto place = [&](const std::string& name) { return place_of(folders.file(name)); };
  for (const std::string inside : {"a", "same", "sub/../a", "../in/a", "link/../in/a"})
    CHECK(place(inside) == InputPlace::inside);
  for (const std::string outside : {"../out/a", "link/a", "../out/none", "none/../../out/a", "..", "../inn"})
    CHECK(place(outside) == InputPlace::outside);
  CHECK(place(out + "/a") == InputPlace::outside);
  for (const std::string missing : {"b", "sub", ".", "dangling", "a/b"})
    CHECK(place(missing) == InputPlace::missing);
  CHECK(place_of(folders.file("link/a", {out})) == InputPlace::inside);
  CHECK(place_of(folders.file("link/a", {out + "/none", out + "x"})) == InputPlace::outside);
  // the user's own word
  CHECK(place_of((folders.path / "in/link/a").string()) == InputPlace::inside);
}

TEST_CASE("a file outside its folders is not opened, and the reason says how to allow it") {
  const TwoFolders folders;
  CHECK(SourceText::open(folders.file("same"), 0).text() == "inside");
  const std::string out = (folders.path / "out").string();
  CHECK(SourceText::open(folders.file("link/a", {out}), 0).text() == "outside");
  for (const std::string name : {"link/a", "../out/a"}) {
    try {
      SourceText::open(folders.file(name), 0);
      FAIL("was opened");
    } catch (const UnreadableText& e) {
      CHECK(e.code() == std::errc::operation_not_permitted);
      CHECK(e.reason() == "lies outside " + (folders.path / "in").string() +
                              "; --allow DIR allows files below another folder");
    }
  }
  CHECK_THROWS_AS(SourceText::open(folders.file("none"), 0), UnreadableText);
  // "-" is a file's name where a file names it
  folders.write("in/-", "dash");
  CHECK(SourceText::open(folders.file("-"), 0).text() == "dash");
}

TEST_CASE("no part of a path that is opened may have become a link") {
  const TwoFolders folders;
  CHECK(opens(folders.path / "in/a"));
  CHECK_FALSE(opens(folders.path / "in/same"));
  CHECK_FALSE(opens(folders.path / "in/link/a"));
  CHECK_FALSE(opens(folders.path / "in/none"));
}

TEST_CASE("a file that is swapped for a link all the time never gives a line of an outside file") {
  const TwoFolders folders;
  const fs::path file = folders.path / "in/swapped", other = folders.path / "in/other";
  folders.write("in/swapped", "inside");
  std::atomic<bool> ends = false;
  std::thread swapper([&] {
    while (!ends) {
      fs::create_symlink("../out/a", other);
      fs::rename(other, file);
      folders.write("in/other", "inside");
      fs::rename(other, file);
    }
  });
  int read = 0, refused = 0, outside = 0;
  for (int i = 0; i < 5000; ++i) {
    try {
      const SourceText text = SourceText::open(folders.file("swapped"), 0);
      ++(text.text() == "outside" ? outside : read);
    } catch (const UnreadableText&) {
      ++refused;
    }
  }
  ends = true;
  swapper.join();
  CHECK(outside == 0);
  CHECK(read > 0);
  CHECK(refused > 0);
}

TEST_CASE("a file's name in a log is that of the file that names it, or has no folders") {
  CHECK(InputFile("a/b/c.ngc").name() == "c.ngc");
  CHECK(InputFile("/c.ngc").name() == "c.ngc");
  CHECK(InputFile("-").name() == "stdin");
  CHECK(InputFile("sub/c.ngc", InputFolders{"a/b"}).name() == "sub/c.ngc");
  CHECK(InputFile("../c.ngc", InputFolders{"a/b"}).name() == "../c.ngc");
  CHECK(InputFile("c.ngc", InputFolders{""}).name() == "c.ngc");
  CHECK(InputFile("/far/c.ngc", InputFolders{"a"}).name() == "/far/c.ngc");
  CHECK(InputFolders{"", {"x"}}.text() == "the current folder, x");
}

#include "machine/base/output_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "machine/base/diagnostic.h"
#include "machine/base/input_files.h"

using namespace kadr;

namespace {

namespace fs = std::filesystem;

/// A new empty folder, removed at the end.
class OutputFolder {
 public:
  OutputFolder() {
    std::string pattern = (fs::temp_directory_path() / "kadr_output_XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return path_ + '/' + name; }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name, std::ios::binary) << text;
  }
  std::string text(const std::string& name) const {
    std::ostringstream out;
    out << std::ifstream(*this / name, std::ios::binary).rdbuf();
    return out.str();
  }
  /// Names in the folder, in order, a blank after each.
  std::string names() const {
    std::vector<std::string> list;
    for (const auto& entry : fs::directory_iterator(path_)) list.push_back(entry.path().filename().string());
    std::sort(list.begin(), list.end());
    std::string all;
    for (const std::string& name : list) all += name + ' ';
    return all;
  }

 private:
  std::string path_;
};

/// Writes a whole text; the reason if that fails.
std::string write_whole(const std::string& path, const std::string& text, OutputRules rules = {}) {
  auto file = OutputFile::open(path, rules);
  if (!file) return file.error().reason;
  if (auto done = file->write(text); !done) return done.error().reason;
  const auto done = file->finish();
  return done ? "" : done.error().reason;
}

/// Runs work in a child process and returns its exit code; the child can end without destructors, as a killed one does.
int exit_of_child(const std::function<int()>& work) {
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

TEST_CASE("a file appears under its name when it is whole, and what was there before stays until then") {
  const OutputFolder folder;
  folder.put("a", "old");
  {
    auto file = OutputFile::open(folder / "a");
    REQUIRE(file);
    REQUIRE(file->write("new"));
    REQUIRE(file->flush());
    CHECK(folder.text("a") == "old");
    CHECK(folder.text("a.part") == "new");
    REQUIRE(file->finish());
  }
  CHECK(folder.text("a") == "new");
  CHECK(folder.names() == "a ");
}

TEST_CASE("a file that is not finished leaves nothing, or PATH.part where that is promised") {
  const OutputFolder folder;
  folder.put("a", "old");
  for (const bool keeps : {false, true}) {
    auto file = OutputFile::open(folder / "a", {.keeps_part = keeps});
    REQUIRE(file);
    REQUIRE(file->write("new"));
  }
  CHECK(folder.text("a") == "old");
  CHECK(folder.text("a.part") == "new");
  CHECK(folder.names() == "a a.part ");
}

TEST_CASE("pieces of any size come out as one text") {
  const OutputFolder folder;
  std::string whole;
  auto file = OutputFile::open(folder / "a");
  REQUIRE(file);
  for (const std::size_t size : {0, 1, 200'000, 100'000, 262'144, 600'000, 3, 262'143, 262'145}) {
    const std::string piece(size, static_cast<char>('a' + whole.size() % 26));
    whole += piece;
    REQUIRE(file->write(piece));
  }
  REQUIRE(file->finish());
  CHECK(folder.text("a") == whole);
}

TEST_CASE("a replaced file keeps its permissions") {
  const OutputFolder folder;
  folder.put("a", "old");
  for (const mode_t mode : {mode_t{0600}, mode_t{0640}, mode_t{0755}}) {
    REQUIRE(::chmod((folder / "a").c_str(), mode) == 0);
    CHECK(write_whole(folder / "a", "new") == "");
    struct stat status {};
    REQUIRE(::stat((folder / "a").c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == mode);
  }
}

TEST_CASE("a link stays a link, and the file that it names is replaced, or made where there is none") {
  const OutputFolder folder;
  fs::create_directory(folder / "sub");
  folder.put("sub/there", "old");
  fs::create_symlink("sub/there", folder / "link");
  fs::create_symlink("link", folder / "second");
  fs::create_symlink("sub/new", folder / "dangling");
  fs::create_symlink("round", folder / "round");
  CHECK(write_whole(folder / "second", "new") == "");
  CHECK(fs::is_symlink(folder / "second"));
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(folder.text("sub/there") == "new");
  CHECK(write_whole(folder / "dangling", "made") == "");
  CHECK(fs::is_symlink(folder / "dangling"));
  CHECK(folder.text("sub/new") == "made");
  CHECK(write_whole(folder / "round", "x") == std::strerror(ELOOP));
  CHECK(folder.names() == "dangling link round second sub ");
}

TEST_CASE("PATH.part is never opened through a link, and what is no leftover stays") {
  const OutputFolder folder;
  folder.put("victim", "precious");
  fs::create_symlink("victim", folder / "a.part");
  fs::create_directory(folder / "b.part");
  REQUIRE(::mkfifo((folder / "c.part").c_str(), 0600) == 0);
  for (const char* name : {"a", "b", "c"})
    CHECK(write_whole(folder / name, "new").find("what has that name can't be replaced") !=
          std::string::npos);
  CHECK(folder.text("victim") == "precious");
  CHECK(folder.names() == "a.part b.part c.part victim ");
  // a second name of a file is not written through either
  fs::create_hard_link(folder / "victim", folder / "d.part");
  CHECK(write_whole(folder / "d", "new") == "");
  CHECK(folder.text("victim") == "precious");
}

TEST_CASE("what a killed writer left behind is replaced") {
  const OutputFolder folder;
  CHECK(exit_of_child([&] {
          auto file = OutputFile::open(folder / "a", {.keeps_part = true});
          if (!file || !file->write("half") || !file->flush()) return 1;
          ::_exit(7);
        }) == 7);
  CHECK(folder.text("a.part") == "half");
  CHECK(write_whole(folder / "a", "whole") == "");
  CHECK(folder.text("a") == "whole");
  CHECK(folder.names() == "a ");
}

TEST_CASE(
    "of two writers of one name the second is refused, in this process and in another, and the first is "
    "whole") {
  const OutputFolder folder;
  fs::create_symlink("a", folder / "link");
  auto first = OutputFile::open(folder / "a");
  REQUIRE(first);
  REQUIRE(first->write("first"));
  for (const char* name : {"a", "link"}) {
    CHECK(write_whole(folder / name, "second").find("another kadr is writing it") != std::string::npos);
    CHECK(exit_of_child([&] { return OutputFile::open(folder / name).has_value() ? 1 : 0; }) == 0);
  }
  REQUIRE(first->finish());
  CHECK(folder.text("a") == "first");
  CHECK(write_whole(folder / "a", "third") == "");
  CHECK(folder.text("a") == "third");
}

TEST_CASE("many writers of one name at once: each that says yes had its own whole text under that name") {
  const OutputFolder folder;
  std::vector<std::thread> writers;
  std::atomic<int> good{0}, broken{0};
  for (int w = 0; w < 4; ++w)
    writers.emplace_back([&, w] {
      const std::string text(50'000, static_cast<char>('a' + w));
      for (int i = 0; i < 50; ++i) {
        if (!write_whole(folder / "a", text).empty()) continue;
        ++good;
        const std::string read = folder.text("a");
        if (read.size() != text.size() || read.find_first_not_of(read[0]) != std::string::npos) ++broken;
      }
    });
  for (std::thread& writer : writers) writer.join();
  CHECK(good > 0);
  CHECK(broken == 0);
  CHECK(folder.names() == "a ");
}

TEST_CASE("a FIFO and a device are written into and stay what they are") {
  const OutputFolder folder;
  REQUIRE(::mkfifo((folder / "fifo").c_str(), 0600) == 0);
  std::string got;
  std::thread reader([&] { got = folder.text("fifo"); });
  CHECK(write_whole(folder / "fifo", "through") == "");
  reader.join();
  CHECK(got == "through");
  CHECK(fs::is_fifo(folder / "fifo"));
  CHECK(written_as(folder / "fifo") == folder / "fifo");
  // the null device under a name of this folder: only root makes nodes, and not everywhere
  if (::mknod((folder / "null").c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) {
    MESSAGE("not tested: this user can't make a device node");
    return;
  }
  CHECK(write_whole(folder / "null", "away") == "");
  CHECK(fs::is_character_file(folder / "null"));
  CHECK(folder.names() == "fifo null ");
}

TEST_CASE("folders, sockets and what may not be written are refused") {
  const OutputFolder folder;
  fs::create_directory(folder / "sub");
  CHECK(write_whole(folder / "sub", "x") == "is a folder");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, (folder / "socket").c_str(), sizeof address.sun_path - 1);
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  CHECK(write_whole(folder / "socket", "x") == "is neither a regular file, nor a pipe or character device");
  ::close(socket);
  CHECK(write_whole(folder / "no/such", "x") == std::strerror(ENOENT));
  folder.put("mine", "kept");
  CHECK(write_whole(folder / "mine", "x", {.overwrite = false}) == std::strerror(EEXIST));
  fs::create_symlink("nowhere", folder / "dangling");
  CHECK(write_whole(folder / "dangling", "x", {.overwrite = false}) == std::strerror(EEXIST));
  CHECK(folder.text("mine") == "kept");
  CHECK(folder.names() == "dangling mine socket sub ");
}

TEST_CASE("a file that came to the name meanwhile is not overwritten where that was not wanted") {
  const OutputFolder folder;
  auto file = OutputFile::open(folder / "a", {.overwrite = false});
  REQUIRE(file);
  folder.put("a", "theirs");
  CHECK_FALSE(file->finish());
  CHECK(folder.text("a") == "theirs");
}

TEST_CASE("PATH.part that was taken away or exchanged is not given the name") {
  const OutputFolder folder;
  {
    auto file = OutputFile::open(folder / "a");
    REQUIRE(file);
    REQUIRE(file->write("mine"));
    fs::remove(folder / "a.part");
    folder.put("a.part", "theirs");
    const auto done = file->finish();
    REQUIRE_FALSE(done);
    CHECK(done.error().reason.find("moved or replaced while it was written") != std::string::npos);
    CHECK_FALSE(fs::exists(folder / "a"));
  }
  // nor is what is there now taken away
  CHECK(folder.text("a.part") == "theirs");
}

TEST_CASE("no output replaces a file that was read, by any of its names, nor is written beside into one") {
  const OutputFolder folder;
  const InputMemory inputs;
  folder.put("input", "text");
  folder.put("b.part", "a log under way");
  fs::create_symlink("input", folder / "link");
  fs::create_hard_link(folder / "input", folder / "twin");
  for (const char* name : {"input", "b.part"}) SourceText::open(folder / name, 0);
  for (const char* name : {"input", "link", "twin", "./input", "b"})
    CHECK(write_whole(folder / name, "x").find("this output would overwrite an input") == 0);
  CHECK(folder.text("input") == "text");
  CHECK(folder.text("b.part") == "a log under way");
  // nor does one that is standard output
  const int before = ::dup(STDOUT_FILENO);
  const int onto = ::open((folder / "input").c_str(), O_WRONLY | O_APPEND);
  REQUIRE(::dup2(onto, STDOUT_FILENO) == STDOUT_FILENO);
  const std::string said = write_whole(folder / "input", "x");
  REQUIRE(::dup2(before, STDOUT_FILENO) == STDOUT_FILENO);
  ::close(before);
  ::close(onto);
  CHECK(said.find("this output would overwrite an input") == 0);
  CHECK(folder.text("input") == "text");
  // but on purpose, as a formatter does
  CHECK(write_whole(folder / "input", "formatted", {.own_input = true}) == "");
  CHECK(folder.text("input") == "formatted");
}

TEST_CASE("a write that fails says why and leaves nothing under the name") {
  const OutputFolder folder;
  folder.put("a", "old");
  CHECK(exit_of_child([&] {
          std::signal(SIGXFSZ, SIG_IGN);
          const rlimit bound{4096, 4096};
          if (::setrlimit(RLIMIT_FSIZE, &bound) != 0) return 1;
          return write_whole(folder / "a", std::string(10'000, 'x')) == std::strerror(EFBIG) ? 0 : 2;
        }) == 0);
  CHECK(folder.text("a") == "old");
  CHECK(folder.names() == "a ");
}

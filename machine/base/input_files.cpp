#include "machine/base/input_files.h"

#include <mutex>
#include <set>
#include <utility>

namespace kadr {
namespace {

struct InputFiles {
  std::mutex mutex;
  bool remembers = false;
  std::set<std::pair<dev_t, ino_t>> files, outputs;
};

InputFiles& input_files() {
  static InputFiles files;
  return files;
}

}  // namespace

InputMemory::InputMemory() {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  inputs.remembers = true;
}

InputMemory::~InputMemory() {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  inputs.remembers = false;
  inputs.files.clear();
  inputs.outputs.clear();
}

void note_input_file(const struct stat& status) {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  // what is read from a pipe or device can't be replaced
  if (inputs.remembers && S_ISREG(status.st_mode)) inputs.files.emplace(status.st_dev, status.st_ino);
}

bool is_input_file(const struct stat& status) {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  return inputs.files.contains({status.st_dev, status.st_ino});
}

void note_output_file(const struct stat& status) {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  if (inputs.remembers) inputs.outputs.emplace(status.st_dev, status.st_ino);
}

bool is_output_file(const struct stat& status) {
  InputFiles& inputs = input_files();
  const std::scoped_lock lock(inputs.mutex);
  return inputs.outputs.contains({status.st_dev, status.st_ino});
}

}  // namespace kadr

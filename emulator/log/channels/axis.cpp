#include "emulator/log/channels/axis.h"

#include "emulator/log/channels/run.h"

namespace kadr::log {

const char* check_message(AxisSample& sample, std::string_view channel, const LogHeader& header) {
  const std::string_view letter = channel.substr(Channel<AxisSample>::info.name.size());
  for (std::size_t a = 0; a < header.axis.size(); ++a)
    if (header.axis[a].name == letter) sample.axis = static_cast<int>(a);
  return sample.axis >= 0 ? nullptr : "the header has no such axis";
}

}  // namespace kadr::log

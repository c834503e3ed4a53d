#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "emulator/log/channel.h"

/// The channels in words, from their tables: what tests keep emulator/log/kadr.lcm and docs/log_format.md to.
namespace kadr::log {

struct ChannelDescription {
  ChannelTitle title;
  std::int64_t fingerprint = 0;
  std::vector<FieldInfo> fields;
};

/// Every channel, in the order of kadr.lcm.
std::vector<ChannelDescription> describe_channels();

/// emulator/log/kadr.lcm: LCM's types, for lcm-spy and other readers.
std::string lcm_definition();
/// Markdown table of channels, types, fingerprints and when they are written.
std::string channel_table();
/// Markdown: of each channel the table of its fields.
std::string field_tables();

}  // namespace kadr::log

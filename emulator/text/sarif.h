#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "emulator/text/json.h"
#include "machine/base/diagnostic.h"

namespace kadr::text {

/// The diagnostics of a command as one document of SARIF 2.1.0, the form in which code hosts and editors take
/// the findings of a checker: a rule for each code used, a result for each diagnostic, errors first. A pure
/// function of the diagnostics, so equal runs give equal bytes.
class SarifLog {
 public:
  /// @param folder  absolute path; files below it are named relative to it, as a repository wants them
  explicit SarifLog(std::string folder) : folder_(std::move(folder)) {}

  void add(const Diagnostic& d, const SourceSet& sources);
  /// @param exit_code  of the command; 2 and those from 70 on mean that it could not do its work
  Json document(int exit_code) const;

 private:
  struct Result {
    Severity severity;
    Code code;
    Json json;
  };

  Json location(const Span& span, const SourceSet& sources) const;
  std::string uri(const std::string& name) const;
  std::string fingerprint(const Diagnostic& d, const SourceSet& sources);

  std::string folder_;
  std::vector<Result> results_;
  std::set<Code> codes_;
  std::map<std::string, int> seen_;  ///< file and fingerprint: how often
  /// Of long lines, by code, file, line and length.
  std::map<std::tuple<Code, std::string, std::uint32_t, std::size_t>, std::string> line_hashes_;
};

}  // namespace kadr::text

#pragma once
#include <array>
#include <string>
#include <vector>

#include "emulator/log/channel.h"

namespace kadr::log {

/// KADR_DIAG
struct LogDiagnostic {
  Ticks tick;  ///< -1 if before the run
  Severity severity = Severity::error;
  std::string code;  ///< "K2107"
  Span span;
  std::string message, label;
  std::vector<std::string> notes;
  std::string help;
};

LogDiagnostic log_diagnostic(const Diagnostic& d, Ticks tick);

template <std::same_as<LogDiagnostic> R>
struct Channel<R> {
  static constexpr ChannelTitle info{"KADR_DIAG", "diag_t", "what `kadr check` would print"};
  static constexpr std::size_t first_fields = 11;
  static constexpr std::array fields{
      field::i64<&R::tick>("tick", "-1 if before the run"),
      field::i8<&R::severity>("severity", "1 note 2 warning 3 error"),
      field::text<&R::code>("code", "\"K2107\""),
      field::i32<&R::span, &Span::line>("source_line", "from 1"),
      field::i32<&R::span, &Span::column>("source_column", "from 1"),
      field::i32<&R::span, &Span::length>("source_length", "in bytes").not_compared(),
      field::text<&R::message>("text", "one sentence"),
      field::text<&R::label>("label", "beside the caret"),
      field::count<R, field::length<&R::notes>>("n_notes", CountRule::any),
      field::text<&R::notes>("notes", "").by("n_notes"),
      field::text<&R::help>("help", "what to do"),
  };
};

}  // namespace kadr::log

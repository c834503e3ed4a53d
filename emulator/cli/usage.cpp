#include "emulator/cli/usage.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

#include "machine/file/units.h"

namespace kadr::cli {
namespace {

/// Options that may be given more than once collect their values.
bool repeatable(const CLI::Option& option) {
  return option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll || option.get_expected_max() > 1;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "--machine", or "-h" of an option that has no long name.
std::string name_of(const CLI::Option& option) {
  return option.get_lnames().empty() ? "-" + option.get_snames().front() : "--" + option.get_lnames().front();
}

/// A value may begin with a minus sign; `-` alone is standard input.
bool looks_like_option(const std::string& text) {
  return text.size() > 1 && text[0] == '-' && text[1] != '.' && !(text[1] >= '0' && text[1] <= '9');
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  std::vector<const CLI::Option*> all = command.get_options();
  // groups are commands without a name
  for (const CLI::App* group :
       command.get_subcommands([](const CLI::App* s) { return s->get_name().empty(); }))
    for (const CLI::Option* option : group->get_options()) all.push_back(option);
  return all;
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

/// The word nearest to a mistyped one; empty if none is near. One that the other begins with counts as near.
std::string nearest(const std::string& text, const std::vector<std::string>& words) {
  std::string best;
  int least = 1 + static_cast<int>(text.size()) / 3;
  for (const std::string& word : words) {
    const std::size_t shorter = std::min(word.size(), text.size());
    const bool begins = shorter > 3 && word.compare(0, shorter, text, 0, shorter) == 0;
    const int edits = begins ? 0 : machine::edit_distance(text, word);
    if (edits >= least) continue;
    least = edits;
    best = word;
  }
  return best;
}

class Scan {
 public:
  Scan(const CLI::App& app, const std::vector<std::string>& arguments)
      : command_(&app), path_(app.get_name()), rest_(arguments) {}

  std::string run() {
    for (at_ = 0; at_ < rest_.size() && mistake_.empty(); ++at_) {
      const std::string& text = rest_[at_];
      if (text == "--") {
        operands();
        break;
      }
      if (looks_like_option(text))
        text[1] == '-' ? long_option(text) : short_options(text);
      else
        word(text);
    }
    if (mistake_.empty()) count_words();
    // a request for help wins
    return helped_ ? std::string() : mistake_;
  }

  /// For words that must all be commands.
  std::string names_only() {
    for (const std::string& text : rest_) {
      word(text);
      if (mistake_.empty() && !words_.empty()) tell(fmt::format("has no commands; got '{}'", text));
      if (!mistake_.empty()) break;
    }
    return mistake_;
  }

 private:
  void tell(const std::string& sentence) {
    mistake_ = fmt::format("{}: {}", path_, sentence);
    helped_ = helped_ || std::any_of(rest_.begin(), rest_.end(), [](const std::string& text) {
                return text == "--help" || text == "-h";
              });
  }

  static std::vector<std::string> command_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
      if (!sub->get_name().empty()) names.push_back(sub->get_name());
    return names;
  }

  /// After `--` nothing is an option.
  void operands() {
    if (command_names(*command_).empty())
      for (++at_; at_ < rest_.size() && mistake_.empty(); ++at_) word(rest_[at_]);
  }

  void word(const std::string& text) {
    const std::vector<std::string> names = command_names(*command_);
    if (names.empty()) {
      const std::vector<std::string> known = operand_names();
      if (text.empty() && !known.empty())
        return tell(fmt::format("{} is empty: ''", known[std::min(words_.size(), known.size() - 1)]));
      return words_.push_back(text);
    }
    if (std::find(names.begin(), names.end(), text) == names.end()) {
      const std::string near = nearest(text, names);
      return tell(fmt::format("there is no command '{}'; {} {}", text,
                              near.empty() ? "commands:" : fmt::format("did you mean {}? Commands:", near),
                              joined(names)));
    }
    command_ = command_->get_subcommand(text);
    path_ += ' ' + text;
    given_.clear();
    words_.clear();
  }

  const CLI::Option* find(const std::string& name) const {
    for (const CLI::Option* option : options_of(*command_))
      if (option->nonpositional() && option->check_name(name)) return option;
    return nullptr;
  }

  void unknown(const std::string& name) {
    std::vector<std::string> names;
    for (const CLI::Option* option : options_of(*command_))
      for (const std::string& l : option->get_lnames()) names.push_back("--" + l);
    const std::string near = name.size() > 2 ? nearest(name, names) : "";
    std::string advice;
    if (!near.empty())
      advice = fmt::format("; did you mean {}?", near);
    else if (!command_names(*command_).empty())
      advice = "; options follow the command";
    tell(fmt::format("there is no option {}{}", name, advice));
  }

  void long_option(const std::string& text) {
    const auto equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const CLI::Option* option = find(name);
    if (!option) return unknown(name);
    if (equals != std::string::npos) {
      if (takes_value(*option)) return once(*option, text.substr(equals + 1));
      return tell(fmt::format("{} takes no value; got '{}'", name, text.substr(equals + 1)));
    }
    flag_or_value(*option, name);
  }

  void short_options(const std::string& text) {
    const std::string whole = '-' + text.substr(0, text.find('='));
    if (text.size() > 2 && find(whole))
      return tell(fmt::format("there is no option {}; did you mean {}?", whole.substr(1), whole));
    for (std::size_t i = 1; i < text.size() && mistake_.empty(); ++i) {
      const std::string name = std::string("-") + text[i];
      const CLI::Option* option = find(name);
      if (!option) return unknown(i == 1 && text.size() > 2 ? text : name);
      if (takes_value(*option) && i + 1 < text.size()) return once(*option, text.substr(i + 1));
      flag_or_value(*option, name);
    }
  }

  void flag_or_value(const CLI::Option& option, const std::string& name) {
    if (!takes_value(option)) return once(option, {});
    const bool last = at_ + 1 == rest_.size();
    if (last || looks_like_option(rest_[at_ + 1]))
      return tell(fmt::format("{} needs a value ({}){}", name, option.get_type_name(),
                              last ? "" : fmt::format(", but {} follows", rest_[at_ + 1])));
    once(option, rest_[++at_]);
  }

  void once(const CLI::Option& option, const std::string& value) {
    if (takes_value(option) && value.empty())
      return tell(
          fmt::format("{} needs a value ({}); got an empty one", name_of(option), option.get_type_name()));
    const auto [before, first] = given_.emplace(&option, value);
    if (first || repeatable(option)) return;
    const std::string values = takes_value(option)
                                   ? fmt::format(": '{}' and '{}'; it takes one value", before->second, value)
                                   : std::string("; once is enough");
    tell(fmt::format("{} is given twice{}", name_of(option), values));
  }

  std::vector<std::string> operand_names() const {
    std::vector<std::string> names;
    for (const CLI::Option* option : command_->get_options())
      if (option->get_positional()) names.push_back(option->get_name(true));
    return names;
  }

  /// One option of a group, such as --csv, --json, ... of `kadr export`, is required.
  void count_choices() {
    for (const CLI::App* group :
         command_->get_subcommands([](const CLI::App* s) { return s->get_name().empty(); })) {
      if (group->get_require_option_min() == 0) continue;
      std::vector<std::string> known, given;
      for (const CLI::Option* option : group->get_options()) {
        if (option == group->get_help_ptr()) continue;
        known.push_back(name_of(*option));
        if (given_.count(option) > 0) given.push_back(name_of(*option));
      }
      if (given.empty()) return tell(fmt::format("needs one of {}", joined(known)));
      if (given.size() > group->get_require_option_max())
        return tell(fmt::format("takes one of {}; got {}", joined(known), joined(given)));
    }
  }

  void count_words() {
    const std::vector<std::string> names = operand_names();
    std::size_t least = 0, most = 0;
    for (const CLI::Option* option : command_->get_options()) {
      if (!option->get_positional()) continue;
      least += static_cast<std::size_t>(option->get_required() ? option->get_items_expected_min() : 0);
      most += static_cast<std::size_t>(option->get_items_expected_max());
    }
    const std::string name = fmt::format("{}", fmt::join(names, " and "));
    if (words_.size() > most && names.empty())
      tell(fmt::format("takes no argument; got '{}'", words_.front()));
    else if (words_.size() > most)
      tell(fmt::format("takes {}{}; '{}' is one too many",
                       most > names.size() ? fmt::format("at most {} ", most)
                       : most == 1         ? "one "
                                           : "",
                       name, words_[most]));
    else if (least > names.size() && !words_.empty() && words_.size() < least)
      tell(fmt::format("takes at least {} {}; got {}", least, name, words_.size()));
    else if (words_.size() >= least)
      count_choices();
  }

  const CLI::App* command_;
  std::string path_;
  const std::vector<std::string>& rest_;
  std::size_t at_ = 0;
  std::map<const CLI::Option*, std::string> given_;
  std::vector<std::string> words_;  ///< positional arguments
  std::string mistake_;
  bool helped_ = false;
};

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(30); }
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string out;
    if (option->get_type_size() != 0 && !option->get_type_name().empty())
      out += ' ' + option->get_type_name();
    if (takes_value(*option) && repeatable(*option)) out += " ...";
    if (option->get_required() && option->get_positional()) out += " (required)";
    return out;
  }
  std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = option->get_name(true) + (option->get_expected_max() > 1 ? " ..." : "");
    return option->get_required() ? name : "[" + name + "]";
  }
};

}  // namespace

std::string usage_mistake(const CLI::App& app, const std::vector<std::string>& arguments) {
  return Scan(app, arguments).run();
}

std::string unknown_command(const CLI::App& app, const std::vector<std::string>& names) {
  return Scan(app, names).names_only();
}

std::shared_ptr<CLI::Formatter> help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace kadr::cli

// One home for every parameter: a struct's describe() names it once, and parsing, range checks, --set, help,
// the text that is hashed and the reference page follow from that line.
//
//   struct FillOptions {
//     double max_hole_size_spacings = 60;
//     Base base = Base::automatic;
//   };
//   inline void describe(Binder& b, FillOptions& o) {
//     b.number("max_hole_size_spacings", o.max_hole_size_spacings, {0, 1e6}, "fill holes ... ; larger stay
//     open"); b.choice("base", o.base, {{"auto", Base::automatic}, {"flat", Base::flat}}, "what to do with a
//     flat base");
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace drape {

/// What an option holds: unset (an optional without a value), a flag, a whole number, a number, a text (also
/// the name of a choice), or a list of numbers.
using OptionValue =
    std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>>;

enum class OptionKind { flag, integer, number, text, choice, numbers };

/// Inclusive limits of a number, or of each number of a list.
struct Range {
  double least;
  double most;
};

/// One named option of a struct, with access to the member it describes.
struct Option {
  std::string name;
  std::string help;
  OptionKind kind;
  bool may_be_unset = false;         // `key: auto` in YAML leaves it unset
  std::optional<Range> range;        // of numbers
  std::size_t list_size = 0;         // of lists: how many numbers; 0 for any
  std::vector<std::string> choices;  // of choices
  std::function<OptionValue()> get;
  std::function<void(const OptionValue&)> assign;  // the value must have passed check()
};

/// Collects the options of one struct in the order in which describe() names them. The struct must outlive
/// it.
class Binder {
 public:
  void flag(std::string_view name, bool& member, std::string_view help);
  void number(std::string_view name, int& member, Range range, std::string_view help);
  void number(std::string_view name, double& member, Range range, std::string_view help);
  /// Unset means "found by itself"; say in the help how.
  void number(std::string_view name, std::optional<int>& member, Range range, std::string_view help);
  void number(std::string_view name, std::optional<double>& member, Range range, std::string_view help);
  /// A list of numbers, each within `range`; `size` of them, or any count where size is 0.
  void numbers(std::string_view name, std::vector<double>& member, std::size_t size, Range range,
               std::string_view help);
  void text(std::string_view name, std::string& member, std::string_view help);

  template <class Enum>
  void choice(std::string_view name, Enum& member,
              std::initializer_list<std::pair<std::string_view, Enum>> names, std::string_view help) {
    const std::vector<std::pair<std::string, Enum>> table(names.begin(), names.end());
    Option option{std::string(name), std::string(help), OptionKind::choice, false, {}, 0, {}, {}, {}};
    for (const auto& entry : table) option.choices.push_back(entry.first);
    option.get = [&member, table]() -> OptionValue {
      for (const auto& [text, value] : table)
        if (value == member) return text;
      return std::string();
    };
    option.assign = [&member, table](const OptionValue& value) {
      for (const auto& [text, entry] : table)
        if (text == std::get<std::string>(value)) member = entry;
    };
    options_.push_back(std::move(option));
  }

  [[nodiscard]] const std::vector<Option>& options() const { return options_; }

 private:
  std::vector<Option> options_;
};

/// The options of a struct, by its describe().
template <class Struct>
[[nodiscard]] std::vector<Option> options_of(Struct& object) {
  Binder binder;
  describe(binder, object);
  return binder.options();
}

/// Reads one scalar as YAML writes it ("12", "true", "flat", "auto") into a value of the option's kind, and
/// checks the range. Returns the value, or the words for what is wrong ("is 7; must be within 0 and 5").
[[nodiscard]] std::variant<OptionValue, std::string> parse_option(const Option& option,
                                                                  std::string_view text);
/// The same for a list.
[[nodiscard]] std::variant<OptionValue, std::string> parse_option(const Option& option,
                                                                  const std::vector<std::string>& texts);

/// As YAML would write it: for people and for the reference page.
[[nodiscard]] std::string readable(const OptionValue& value);
/// One text per value, exact for numbers (hexadecimal floats): what is hashed.
[[nodiscard]] std::string canonical(const OptionValue& value);

/// Of `names`, the one that `text` is most likely a slip of (Damerau-Levenshtein distance of at most 3 and
/// under half of its length), or empty.
[[nodiscard]] std::string closest(std::string_view text, const std::vector<std::string>& names);

}  // namespace drape

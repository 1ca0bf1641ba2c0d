// A set of rules that owns its words.
#pragma once

#include <vector>

#include "runtime-m4/layers/rule_set.hpp"
#include "runtime-m4/policy/memory.hpp"

namespace robosync::test {

class OwnedRuleSet {
public:
  explicit OwnedRuleSet(unsigned rules) : words_(policy::set_words(rules)) { set_.start(words_); }
  OwnedRuleSet(const OwnedRuleSet&) = delete;
  OwnedRuleSet& operator=(const OwnedRuleSet&) = delete;

  layers::RuleSet& operator*() { return set_; }
  layers::RuleSet* operator->() { return &set_; }

private:
  std::vector<layers::RuleSet::Word> words_;
  layers::RuleSet set_;
};

}  // namespace robosync::test

// SPDX-License-Identifier: Apache-2.0
// docs/mutants.md, of the mutants and what found each.

const seconds = (value) => (value < 10 ? value.toFixed(1) : value.toFixed(0));

function row(mutant, result) {
  const found = result.how.startsWith('test')
    ? `${result.how.replace('test ', '')}: \`${result.what}\``
    : `${result.how}: \`${result.what}\``;
  return `| \`${mutant.name}\` | ${mutant.slip} | ${mutant.promise} | ${found} | ${seconds(result.seconds)} |\n`;
}

export function page(groups, results) {
  const all = groups.flatMap(([, mutants]) => mutants);
  const flown = all.filter((mutant) => !results[mutant.name].how.startsWith('test')).length;
  let text = `# Mutants: planted faults, each of which is found

<!-- Written by ./dev mutants -->

${all.length} slips that a programmer might make, one at a time in a copy of the tree, each of which breaks a promise: ${all.length - flown} are found by a test, ${flown} by a simulated mission that breaks a check and does not
without the mutant. One that nothing finds is a test that is missing ([076](decisions/076-mutants-are-texts-that-must-fit.md)).

    ./dev mutants                       # those that were not found yet; writes this page
    ./dev mutants NAME...               # these
    ./dev mutants --again               # all

A mutant is a text of a source and what stands in its place (\`tests/mutants/planted\`). The test \`mutants_fit\` shows that each text is still there, once, and that this page has the mutant. A run copies the tree to
\`build/mutants\`, shows that the tests pass as it is, and then builds for each mutant the test programs that see it, the nearest first, until one fails; where none does, up to 1,000 missions are flown with drawn faults
(${'`faults-8`, `mixed-6`, `coalition-6`, `coalition-32`; of formations `formation-5`, `formation-planes-5`'}). Mutants of judges are found by the judges' own tests only. The last column is what the test program or the missions took, in seconds, on a loaded
machine with two cores.
`;
  for (const [title, mutants] of groups) {
    text += `\n## ${title}\n\n| mutant | the slip | the promise it breaks | found by | s |\n|---|---|---|---|---|\n`;
    for (const mutant of mutants) text += row(mutant, results[mutant.name]);
  }
  return text;
}

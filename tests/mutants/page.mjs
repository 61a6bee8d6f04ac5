// SPDX-License-Identifier: Apache-2.0
// docs/mutants.md, of the mutants and what found each.

const seconds = (value) => (value < 10 ? value.toFixed(1) : value.toFixed(0));

function foundBy(result) {
  if (result === undefined) return 'not looked for yet |';
  if (result.seconds === undefined) return `**${result.how}** |`;
  return `${result.how.replace('test ', '')}: \`${result.what}\` | ${seconds(result.seconds)}`;
}

// `groups`: a title and its mutants; `results`: what was found by name, of these mutants as they are.
export function page(groups, results) {
  const all = groups.flatMap(([, mutants]) => mutants);
  const looked = all.map((mutant) => results[mutant.name]).filter((result) => result !== undefined);
  const byTest = looked.filter((result) => result.how.startsWith('test ')).length;
  const byMission = looked.filter((result) => result.how.startsWith('mission ')).length;
  const open = all.length - looked.length;
  let text = `# Mutants: planted faults, and what finds each

<!-- Written by ./dev mutants -->

${all.length} slips that a programmer might make, one at a time in a copy of the tree, each of which breaks a promise. Of the ${looked.length} that were looked for, ${byTest} are found by a test and ${byMission} by a simulated mission that breaks a check, and
does not without the mutant; ${looked.length - byTest - byMission} by nothing${open > 0 ? `; ${open} are still to be looked for` : ''}. One that nothing finds is a test that is missing ([076](decisions/076-mutants-are-texts-that-must-fit.md)).

    ./dev mutants                       # those that were not found yet; writes this page
    ./dev mutants NAME...               # these
    ./dev mutants --again               # all

A mutant is a text of a source and what stands in its place (\`tests/mutants/planted\`). The test \`mutants_fit\` shows that each text is still there, once, and that this page is of what was found (\`tests/mutants/found.json\`). A run copies the tree to
\`build/mutants\`, and builds for each mutant the test programs that see it, the nearest first, until a test fails that passes without it; where none does, up to 1,000 missions are flown with drawn faults
(\`faults-8\`, \`mixed-6\`, \`coalition-6\`, \`coalition-32\`; of formations \`formation-5\`, \`formation-planes-5\`). Mutants of judges are looked for by the judges' own tests only. The last column is what the test program took until it failed, or
the missions, in seconds, on a loaded machine with two cores.
`;
  for (const [title, mutants] of groups) {
    text += `\n## ${title}\n\n| mutant | the slip | the promise it breaks | found by | s |\n|---|---|---|---|---|\n`;
    for (const mutant of mutants) {
      text += `| \`${mutant.name}\` | ${mutant.slip} | ${mutant.promise} | ${foundBy(results[mutant.name])} |\n`;
    }
  }
  return text;
}

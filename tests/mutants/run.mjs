// SPDX-License-Identifier: Apache-2.0
//
// Planted faults, one at a time: each is to be found by the tests or by a thousand missions
// (docs/mutants.md).
//   run.mjs check                    every mutant fits the tree, and the page is of what was found
//   run.mjs list | page
//   run.mjs run [--again] [NAME...]  those that were not found yet, or the named ones
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { page } from './page.mjs';
import coalition from './planted/coalition.mjs';
import identity from './planted/identity.mjs';
import judges from './planted/judges.mjs';
import mission from './planted/mission.mjs';
import planning from './planted/planning.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
const pageFile = 'docs/mutants.md';
const work = path.join(root, 'build/mutants');
const source = path.join(work, 'source');
const bin = path.join(source, 'build/release/bin');
const originals = path.join(work, 'original');
const resultsFile = path.join(root, 'tests/mutants/found.json');
const jobs = process.env.SKEIN_JOBS ?? String(spawnSync('nproc', { encoding: 'utf8' }).stdout.trim());
const testSeconds = 900;

const groups = [
  ['The contract net', coalition],
  ['What a vehicle decides of its flight', mission],
  ['Paths, formations, routes, bounds', planning],
  ['Who may say what', identity],
  ['The judges, and what they are given', judges],
];
const mutants = groups.flatMap(([, all]) => all);

// What is flown, as `skein-hil simulate` takes it: 1,000 missions in all.
const missions = [
  ['faults-8', 'mixed', 400],
  ['mixed-6', 'mixed', 200],
  ['coalition-6', 'mixed', 200],
  ['coalition-32', 'mixed', 200],
];
const formations = [['formation-5', 'mixed', 700], ['formation-planes-5', 'mixed', 300]];
const flownAtOnce = 50;

// Which test programs see what is in a folder, and whether missions do; the nearest first, as it ends
// with the first that finds it. Judges are to be found by their own tests.
const seenBy = [
  ['core/domain/', ['domain', 'planning', 'mission', missions, 'simulator']],
  ['core/planning/', ['planning', 'mission', missions, 'simulator']],
  ['core/coupled/', ['coupled', 'hindsight']],
  ['core/coalition/', ['coalition', 'mission', missions, 'simulator']],
  ['core/formation/', ['formation', 'mission', formations, 'simulator']],
  ['core/routes/', ['routes']],
  ['core/mission/', ['mission', missions, 'simulator']],
  ['runtime/identity/', ['identity', 'network']],
  ['runtime/network/', ['network']],
  ['runtime/seal/', ['seal', 'network']],
  ['hil/bench/', ['bench']],
  ['hil/checks/', ['checks']],
  ['hil/hindsight/', ['hindsight']],
  ['hil/simulator/', ['simulator']],
];

function ringsOf(mutant) {
  const found = seenBy.find(([folder]) => mutant.file.startsWith(folder));
  if (!found) throw new Error(`${mutant.name}: run.mjs does not know which tests see ${mutant.file}`);
  return found[1];
}

const say = (text) => process.stderr.write(`mutants: ${text}\n`);
function die(text) {
  say(text);
  process.exit(2);
}

// --- the mutants and the tree ------------------------------------------------------------------

function countOf(text, part) {
  return text.split(part).length - 1;
}

function mutated(mutant, text) {
  return text.split(mutant.from).join(mutant.to);
}

function check() {
  const wrong = [];
  const names = new Set();
  for (const mutant of mutants) {
    if (names.has(mutant.name)) wrong.push(`${mutant.name}: two mutants have this name`);
    names.add(mutant.name);
    ringsOf(mutant);
    const file = path.join(root, mutant.file);
    const text = fs.existsSync(file) ? fs.readFileSync(file, 'utf8') : '';
    const count = countOf(text, mutant.from);
    if (count !== 1) wrong.push(`${mutant.name}: its text is ${count} times in ${mutant.file}, not once`);
    if (mutant.from === mutant.to) wrong.push(`${mutant.name}: changes nothing`);
  }
  if (mutants.length < 30) wrong.push(`${mutants.length} mutants are fewer than 30`);
  const told = path.join(root, pageFile);
  if (!fs.existsSync(told) || fs.readFileSync(told, 'utf8') !== pageOf(readResults())) {
    wrong.push(`${pageFile} is not what was found; 'node tests/mutants/run.mjs page' writes it`);
  }
  for (const text of wrong) say(text);
  if (wrong.length > 0) process.exit(1);
  say(`${mutants.length} mutants fit the tree`);
}

// --- the copy of the tree ----------------------------------------------------------------------

function trackedFiles() {
  const git = spawnSync('git', ['ls-files', '-z', '--cached', '--others', '--exclude-standard'],
    { cwd: root, encoding: 'utf8', maxBuffer: 1 << 26 });
  if (git.status !== 0) die('a clone is needed, to know which files are of the tree');
  return git.stdout.split('\0').filter((file) => file && fs.existsSync(path.join(root, file)));
}

// What is equal keeps its time, so that nothing is built again for it.
function copyTree() {
  const files = trackedFiles();
  for (const file of files) {
    const from = path.join(root, file);
    const to = path.join(source, file);
    const bytes = fs.readFileSync(from);
    if (fs.existsSync(to) && fs.readFileSync(to).equals(bytes)) continue;
    fs.mkdirSync(path.dirname(to), { recursive: true });
    fs.writeFileSync(to, bytes, { mode: fs.statSync(from).mode });
  }
  const known = new Set(files);
  const copied = path.join(work, 'files');
  const before = fs.existsSync(copied) ? fs.readFileSync(copied, 'utf8').split('\n') : [];
  for (const file of before) {
    if (file && !known.has(file)) fs.rmSync(path.join(source, file), { force: true });
  }
  fs.writeFileSync(copied, files.join('\n'));
}

// --- building and looking ----------------------------------------------------------------------

function configure() {
  const ready = path.join(source, 'build/release/build.ninja');
  if (fs.existsSync(ready)) return;
  const cmake = spawnSync('cmake', ['--preset', 'release'], { cwd: source, encoding: 'utf8' });
  if (cmake.status !== 0) die(`cannot configure:\n${cmake.stdout}${cmake.stderr}`);
}

// '' where it was built, else what the compiler says.
function build(...targets) {
  const ninja = spawnSync('ninja', ['-C', 'build/release', '-j', jobs, ...targets],
    { cwd: source, encoding: 'utf8', maxBuffer: 1 << 26 });
  if (ninja.status === 0) return '';
  const errors = ninja.stdout.split('\n').filter((line) => /error|FAILED/.test(line) && !line.includes('-include'));
  return errors.slice(0, 4).join('\n') || ninja.stdout.slice(-1000);
}

// What takes most of a program's time comes last.
const longTests = { coalition: 'Coalition.RandomFaults*' };

// The first test that fails with a mutant and passes without; null where none does. The tests that
// are named as its file is come first.
function firstFailure(test, mutant) {
  const stem = path.parse(mutant.file).name;
  const near = `${stem.replace(/(^|_)(\w)/g, (all, before, letter) => letter.toUpperCase())}*`;
  const long = longTests[test] ?? 'None.None';
  for (const filter of [near, `-${near}:${long}`, long]) {
    const failed = failureOf(path.join(bin, `${test}_test`), filter);
    if (failed && failureOf(path.join(originals, `${test}_test`), failed.name) === null) return failed.text;
    if (failed) die(`without any mutant ${failed.name} of ${test}_test fails`);
  }
  return null;
}
function failureOf(program, filter) {
  const run = spawnSync(program, ['--gtest_fail_fast', `--gtest_filter=${filter}`],
    { cwd: source, encoding: 'utf8', maxBuffer: 1 << 28, timeout: testSeconds * 1000, killSignal: 'SIGKILL' });
  if (run.status === 0) return null;
  const failed = run.stdout.match(/^\[ {2}FAILED {2}\] ([\w/.]+)/m);
  if (failed) return { name: failed[1], text: failed[1] };
  const begun = [...run.stdout.matchAll(/^\[ RUN {6}\] ([\w/.]+)/gm)].pop();
  const name = begun ? begun[1] : '*';
  return { name, text: `${name} (${run.error?.code === 'ETIMEDOUT' ? 'does not end' : 'an assertion ends it'})` };
}

function simulate(program, scenario, faults, more) {
  return spawnSync(program, ['simulate', `scenarios/${scenario}.yaml`, '--faults', faults, ...more],
    { cwd: source, encoding: 'utf8', maxBuffer: 1 << 28 });
}

// The first mission that breaks a check here, and does not without the mutant.
function firstViolation(flights) {
  const program = path.join(bin, 'skein-hil');
  let flown = 0;
  for (const [scenario, faults, runs] of flights) {
    for (let first = 1; first <= runs; first += flownAtOnce) {
      const many = simulate(program, scenario, faults,
        ['--runs', String(flownAtOnce), '--seed', String(first), '--jobs', jobs]);
      const crashed = many.status !== 0 && many.status !== 1;
      const seeds = crashed ? Array.from({ length: flownAtOnce }, (_, i) => String(first + i))
        : [...many.stdout.matchAll(/^seed (\d+) VIOLATED/gm)].map((found) => found[1]);
      for (const seed of seeds) {
        const here = simulate(program, scenario, faults, ['--seed', seed]);
        if (here.status === 0 || simulate(path.join(originals, 'skein-hil'), scenario, faults, ['--seed', seed]).status !== 0) continue;
        const broken = here.stdout.match(/VIOLATED:?\s+([\w ]+?)[:(]/);
        return { how: `mission ${flown + Number(seed) - first + 1}`,
          what: `${scenario} --faults ${faults} --seed ${seed}${here.status === 1 && broken ? ` (${broken[1].trim()})` : ''}` };
      }
      flown += flownAtOnce;
    }
  }
  return null;
}

// --- what finds a mutant ---------------------------------------------------------------------

// The program without any mutant: what fails with one and fails here, too, shows nothing.
const kept = new Set();
function keepOriginal(program) {
  if (kept.has(program)) return;
  const wrong = build(program);
  if (wrong) die(`the tree as it is does not build:\n${wrong}`);
  fs.mkdirSync(originals, { recursive: true });
  fs.copyFileSync(path.join(bin, program), path.join(originals, program));
  kept.add(program);
}

function withMutant(mutant, act) {
  const file = path.join(source, mutant.file);
  const text = fs.readFileSync(file, 'utf8');
  if (countOf(text, mutant.from) !== 1) die(`${mutant.name}: does not fit ${mutant.file}; see 'run.mjs check'`);
  fs.writeFileSync(file, mutated(mutant, text));
  try {
    return act();
  } finally {
    fs.writeFileSync(file, text);
  }
}

// In the nearest test program, then in those farther away; null: not there.
function lookIn(mutant, ring) {
  const where = ringsOf(mutant)[ring];
  if (where === undefined) return { how: 'survives', what: '' };
  const flights = Array.isArray(where) ? where : null;
  const program = flights ? 'skein-hil' : `${where}_test`;
  keepOriginal(program);
  return withMutant(mutant, () => {
    const wrong = build(program);
    if (wrong) return { how: 'does not compile', what: wrong };
    const begun = Date.now();
    const found = flights ? firstViolation(flights) : firstFailure(where, mutant);
    const seconds = (Date.now() - begun) / 1000;
    if (found === null) return null;
    return flights ? { ...found, seconds } : { how: `test ${where}`, what: found, seconds };
  });
}

// --- a run -------------------------------------------------------------------------------------

// What was found is of the mutant as it was then.
const keyOf = (mutant) => createHash('sha256').update(JSON.stringify([mutant.file, mutant.from, mutant.to])).digest('hex').slice(0, 16);

function readResults() {
  return fs.existsSync(resultsFile) ? JSON.parse(fs.readFileSync(resultsFile, 'utf8')) : {};
}
function keepResult(results, mutant, result) {
  results[mutant.name] = { ...result, key: keyOf(mutant) };
  const inOrder = Object.fromEntries(mutants.filter(({ name }) => results[name]).map(({ name }) => [name, results[name]]));
  fs.writeFileSync(`${resultsFile}.new`, `${JSON.stringify(inOrder, null, 1)}\n`);
  fs.renameSync(`${resultsFile}.new`, resultsFile);
}
const isFound = (result) => result !== undefined && !['survives', 'does not compile'].includes(result.how);

function run(arguments_) {
  const again = arguments_[0] === '--again';
  const names = again ? arguments_.slice(1) : arguments_;
  for (const name of names) {
    if (!mutants.some((mutant) => mutant.name === name)) die(`there is no mutant '${name}'; 'run.mjs list' names them`);
  }
  fs.mkdirSync(source, { recursive: true });
  const results = readResults();
  const known = (mutant) => results[mutant.name]?.key === keyOf(mutant) && isFound(results[mutant.name]);
  const wanted = mutants.filter((mutant) => (names.length > 0 ? names.includes(mutant.name) : again || !known(mutant)));
  copyTree();
  configure();
  say(`${wanted.length} of ${mutants.length} mutants`);
  let open = wanted;
  for (let ring = 0; open.length > 0; ++ring) {
    open = open.filter((mutant) => {
      const result = lookIn(mutant, ring);
      if (result === null) return true;
      keepResult(results, mutant, result);
      say(`${mutant.name}: ${result.how}: ${result.what}`);
      return false;
    });
  }
  writePage(results);
  const missing = mutants.filter((mutant) => !known(mutant));
  for (const mutant of missing) {
    const state = results[mutant.name] ? 'NOT FOUND' : 'not looked for yet';
    say(`${state}: ${mutant.name} (${mutant.file}): ${mutant.slip}`);
  }
  process.exit(missing.length > 0 ? 1 : 0);
}

function pageOf(results) {
  const newest = Object.fromEntries(mutants.filter((mutant) => results[mutant.name]?.key === keyOf(mutant))
    .map((mutant) => [mutant.name, results[mutant.name]]));
  return page(groups, newest);
}
const writePage = (results) => fs.writeFileSync(path.join(root, pageFile), pageOf(results));

const [command, ...rest] = process.argv.slice(2);
if (command === 'check') check();
else if (command === 'list') for (const mutant of mutants) console.log(`${mutant.name}\t${mutant.file}\t${mutant.slip}`);
else if (command === 'page') writePage(readResults());
else if (command === 'run') run(rest);
else die('run.mjs check, list, page, or run [--again] [NAME...]');

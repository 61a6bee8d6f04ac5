// SPDX-License-Identifier: Apache-2.0
// What the programs are made of, as SPDX 2.3 in JSON: the packages of this machine whose libraries
// they load, those that they were built with, and the console page's, of npm.
//   parts.mjs VERSION PAGE_LOCK OUT -- PROGRAM... -- PACKAGE...
import { execFileSync } from 'node:child_process'
import { createHash } from 'node:crypto'
import { readFileSync, realpathSync, writeFileSync } from 'node:fs'
import { basename } from 'node:path'

const [version, lock_file, out, , ...rest] = process.argv.slice(2)
const border = rest.indexOf('--')
const programs = rest.slice(0, border)
const built_with = rest.slice(border + 1)
const run = (program, ...words) => execFileSync(program, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] })
const unique = list => [...new Set(list)].sort()

const libraries = unique(programs.flatMap(program =>
  [...run('ldd', program).matchAll(/=> (\/\S+)/g)].map(found => realpathSync(found[1]))))
// dpkg knows files of /lib by the place that they had before /usr was merged.
const owner = file => {
  for (const name of [file, file.replace(/^\/usr/, '')]) {
    try {
      return run('dpkg-query', '--search', name).split(':')[0]
    } catch {}
  }
  throw new Error(`${file} is of no package`)
}
const loaded = unique(libraries.map(owner))

const field = name => '${' + name + '}\\n'
const debian = name => {
  const [found, source, source_version, architecture, home] =
    run('dpkg-query', '--show', '--showformat', ['Version', 'source:Package', 'source:Version', 'Architecture', 'Homepage'].map(field).join(''), name).split('\n')
  return { name, version: found, home,
    purl: `pkg:deb/debian/${name}@${encodeURIComponent(found)}?arch=${architecture}&upstream=${source}%40${encodeURIComponent(source_version)}` }
}
const npm = Object.entries(JSON.parse(readFileSync(lock_file, 'utf8')).packages)
  .filter(([path, entry]) => path !== '' && !entry.dev)
  .map(([path, entry]) => {
    const name = path.replace(/^.*node_modules\//, '')
    return { name, version: entry.version, license: entry.license, purl: `pkg:npm/${name.replace('@', '%40')}@${entry.version}` }
  })

const id = (kind, name) => `SPDXRef-${kind}-${name.replace(/[^A-Za-z0-9.-]/g, '-')}`
const part = (kind, { name, version, home, license, purl }) => ({
  SPDXID: id(kind, name), name, versionInfo: version, downloadLocation: 'NOASSERTION', filesAnalyzed: false,
  ...(home && { homepage: home }), ...(license && { licenseDeclared: license }),
  externalRefs: [{ referenceCategory: 'PACKAGE-MANAGER', referenceType: 'purl', referenceLocator: purl }] })
const relation = (from, how, to) => ({ spdxElementId: from, relationshipType: how, relatedSpdxElement: to })

const own = { SPDXID: 'SPDXRef-skein', name: 'skein', versionInfo: version, downloadLocation: 'NOASSERTION', filesAnalyzed: false, licenseDeclared: 'Apache-2.0',
  comment: `${programs.map(program => basename(program)).join(', ')}` }
const libraries_of = loaded.map(name => part('library', debian(name)))
const builders = unique(built_with).filter(name => !loaded.includes(name)).map(name => part('build', debian(name)))
const page = npm.map(entry => part('npm', entry))
const document = {
  spdxVersion: 'SPDX-2.3', dataLicense: 'CC0-1.0', SPDXID: 'SPDXRef-DOCUMENT', name: `skein-${version}`,
  packages: [own, ...libraries_of, ...builders, ...page],
  relationships: [relation('SPDXRef-DOCUMENT', 'DESCRIBES', own.SPDXID),
    ...libraries_of.map(one => relation(own.SPDXID, 'DYNAMIC_LINK', one.SPDXID)),
    ...builders.map(one => relation(one.SPDXID, 'BUILD_DEPENDENCY_OF', own.SPDXID)),
    ...page.map(one => relation(own.SPDXID, 'CONTAINS', one.SPDXID))] }
const digest = createHash('sha256').update(JSON.stringify(document)).digest('hex')
const seconds = Number(process.env.SOURCE_DATE_EPOCH ?? Date.now() / 1000)
writeFileSync(out, JSON.stringify({ ...document, documentNamespace: `https://spdx.org/spdxdocs/skein-${version}-${digest}`,
  creationInfo: { created: new Date(Math.floor(seconds) * 1000).toISOString().replace('.000', ''), creators: ['Tool: packaging/parts.mjs'] } }, null, 1) + '\n')

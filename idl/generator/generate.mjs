// SPDX-License-Identifier: Apache-2.0
//
// node generate.mjs OUTPUT_FOLDER TOPICS.json FILE.idl...: each file after those that it includes. A
// file that would not change is left alone, so that nothing is built anew for it.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs'
import { dirname, join } from 'node:path'
import { fields_header, may_say_source, message_header, message_source, topics_document, topics_header, types_header, variants_source } from './cpp.mjs'
import { load } from './model.mjs'
import { schemas_source, typescript, wire_idl } from './schemas.mjs'

const [out, topics_file, ...files] = process.argv.slice(2)

function write(name, text) {
  const path = join(out, name)
  mkdirSync(dirname(path), { recursive: true })
  if (!existsSync(path) || readFileSync(path, 'utf8') !== text) writeFileSync(path, text)
}

try {
  const model = load(files)
  const topics = JSON.parse(readFileSync(topics_file, 'utf8'))
  for (const file of model.files) {
    write(`types/${file.name}/skein/idl/${file.name}.hpp`, types_header(model, file))
    write(`fields/skein/idl/${file.name}_fields.hpp`, fields_header(model, file))
    const variants = variants_source(file)
    if (variants) write(`${file.name}.cpp`, variants)
  }
  write('types/message/skein/idl/message.hpp', message_header(model, topics))
  write('message.cpp', message_source())
  write('fields/skein/idl/topics.hpp', topics_header(model, topics))
  write('may_say.cpp', may_say_source(model, topics))
  write('schemas.cpp', schemas_source(model))
  write('wire.idl', wire_idl(model))
  write('messages.ts', typescript(model))
  write('topics.md', topics_document(model, topics))
} catch (error) {
  console.error(`idl/generator: ${error.message}`)
  process.exit(1)
}

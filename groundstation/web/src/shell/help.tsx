// SPDX-License-Identifier: Apache-2.0
import { useEffect, useRef } from "preact/hooks";
import { key_list } from "./keys";
import { help_open } from "./view";

export function Help() {
  const dialog = useRef<HTMLDialogElement>(null);
  const open = help_open.value;
  useEffect(() => {
    if (open && !dialog.current?.open) dialog.current?.showModal();
    if (!open && dialog.current?.open) dialog.current.close();
  }, [open]);
  return (
    <dialog ref={dialog} class="help" aria-labelledby="help-title" data-testid="help" onClose={() => (help_open.value = false)}>
      <h2 id="help-title">Keys and signs</h2>
      <div class="help-columns">
        <table>
          <caption>Keys</caption>
          <tbody>
            {key_list.map(({ keys, what }) => (
              <tr key={keys}>
                <th scope="row">
                  <kbd>{keys}</kbd>
                </th>
                <td>{what}</td>
              </tr>
            ))}
          </tbody>
        </table>
        <dl>
          <dt>Signs on the map</dt>
          <dd>A dart is a vehicle, pointing where it heads; hollow and dashed: silent, at its last known place.</dd>
          <dd>A badge with a letter is its coalition, a ring around the dart its leader.</dd>
          <dd>A square is a site: hollow when found, filled when surveyed, ticked when done.</dd>
          <dd>An arrow at a site is the bearing of a delivery, in the direction of travel: dashed when planned, bold when it has begun, pale when done.</dd>
          <dd>Dashed lines are what is left of planned paths, thin full lines are trails, hatched circles are kept out of.</dd>
          <dt>A delivery</dt>
          <dd>is an overflight of a place on a bearing at a time. Without your authorisation the vehicles hold.</dd>
        </dl>
      </div>
      <form method="dialog">
        <button type="submit" class="primary" data-testid="help-close">
          Close
        </button>
      </form>
    </dialog>
  );
}

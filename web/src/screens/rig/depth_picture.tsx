/**
 * The live picture of the depth camera. The API has none yet; as long as `kAddress` is undefined nothing is shown,
 * and everything the page knows of it is here.
 */
const kAddress: string | undefined = undefined;

export function DepthPicture() {
  if (!kAddress) return null;
  return (
    <section>
      <h2>Depth camera</h2>
      <img class="depth" src={kAddress} alt="Depth over the vat, live: the darker, the farther" />
    </section>
  );
}
